
# The signals of Slurm 22.05, observed on a cluster (scripts/slurm.py starts one):
#  - scancel, scontrol requeue and the end of a pre-emption's grace time: SIGCONT and SIGTERM to this shell and to all its
#    children, SIGKILL to the remaining processes after KillWait (default 30 s);
#  - the start of a pre-emption's grace time: nothing to a batch job (only steps of srun get signals), or the signal of
#    --signal if the site has PreemptParameters=send_user_signal;
#  - the time limit: SIGUSR1 to this shell only, up to a minute earlier than --signal says, then the same as scancel.
# Without traps these signals would end the shell, and SIGKILL would end the worker while it gives its jobs back.
reason=
worker=
asked=
code=3
trap 'reason=stop; ask' TERM
trap 'reason=${reason:-limit}; ask' USR1

say() { printf '%s task %s: %s\n' "$(date +%FT%T)" "$SLURM_ARRAY_TASK_ID" "$*"; }

# Asks the worker to stop. Slurm may have sent it a signal too: the worker takes two signals within a second for one, and
# stops immediately at a later one.
ask() {
    if [ -n "$worker" ] && [ -z "$asked" ]; then
        asked=yes
        kill -TERM "$worker" 2> /dev/null
    fi
}

# Runs a worker until it ends, also if this shell gets signals; the exit code of the worker is in $code.
run() {
    local last
    asked=
    "$@" &
    worker=$!
    # The trap of a signal that came before the line above did not know the worker.
    [ -z "$reason" ] || ask
    while :; do
        wait "$worker"
        code=$?
        [ "$code" -gt 128 ] || break
        # A trapped signal ends `wait` but not the worker.
        kill -0 "$worker" 2> /dev/null && continue
        # The worker has ended: the shell still knows its code, unless the first `wait` returned it.
        wait "$worker" 2> /dev/null
        last=$?
        [ "$last" -eq 127 ] || code=$last
        break
    done
    worker=
    # The worker got the signal before it could handle it.
    if [ -n "$reason" ] && [ "$code" -eq 143 ]; then code=3; fi
}

# Whether to start the worker again: it was killed (by the system because of its memory, or by somebody) and this task was
# not. A job that kills its worker several times fails in the queue before the starts are used up.
restarts() {
    [ -z "$reason" ] && [ "$code" -gt 128 ] || return 1
    if [ "$starts" -eq 0 ]; then
        say "the worker died again (code $code); giving up"
        return 1
    fi
    starts=$((starts - 1))
    say "the worker died (code $code) and is started again"
}

# Runs a command that must not be interrupted: signals to all children of the shell do not end it.
uninterrupted() { (trap '' TERM USR1 && exec "$@"); }

# Requeues this task if the time limit came before the end of the work. It does not after SIGTERM: a cancelled task is not
# wanted any more, and Slurm requeues pre-empted tasks itself. The task is named by array and index, because one of the
# tasks has the same number as the array, and requeueing that number would stop all tasks.
requeue_at_limit() {
    if [ "$reason" = limit ] && [ "$code" -eq 3 ]; then
        say "the time limit is near: continuing in another time slot"
        scontrol requeue "${SLURM_ARRAY_JOB_ID}_${SLURM_ARRAY_TASK_ID}" \
            || say "this task cannot be requeued; run submit.sh again for the jobs that are left"
    fi
}
