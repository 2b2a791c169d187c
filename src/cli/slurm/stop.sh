
# What Slurm 22.05 sends, as seen on a cluster (scripts/slurm.py starts one):
#  - scancel, scontrol requeue and the end of a pre-emption's grace time: SIGCONT and SIGTERM to this shell and to all its
#    children at once, SIGKILL to what is left after KillWait (30 s unless the site says otherwise);
#  - the begin of a pre-emption's grace time: nothing to a batch job (signals go to steps of srun alone), or the signal of
#    --signal where the site has PreemptParameters=send_user_signal;
#  - the time limit: SIGUSR1 to this shell alone, up to a minute earlier than --signal says, then as scancel.
# Without traps the shell would die of these, and the worker of SIGKILL in the middle of giving its jobs back.
reason=
worker=
asked=
code=3
trap 'reason=stop; ask' TERM
trap 'reason=${reason:-limit}; ask' USR1

say() { printf '%s task %s: %s\n' "$(date +%FT%T)" "$SLURM_ARRAY_TASK_ID" "$*"; }

# Asks the worker to stop. Slurm may have told it as well: twice within a second is once to it, later is "at once".
ask() {
    if [ -n "$worker" ] && [ -z "$asked" ]; then
        asked=yes
        kill -TERM "$worker" 2> /dev/null
    fi
}

# Runs a worker to its end, whatever signals come meanwhile; its exit code is in $code.
run() {
    local last
    asked=
    "$@" &
    worker=$!
    # A signal between the start and the line above found no worker to ask.
    [ -z "$reason" ] || ask
    while :; do
        wait "$worker"
        code=$?
        [ "$code" -gt 128 ] || break
        # A trapped signal ends `wait` and not the worker.
        kill -0 "$worker" 2> /dev/null && continue
        # It ended at that very moment: the shell still knows its code, unless that was what `wait` gave before.
        wait "$worker" 2> /dev/null
        last=$?
        [ "$last" -eq 127 ] || code=$last
        break
    done
    worker=
    # Asked to stop before it listened.
    if [ -n "$reason" ] && [ "$code" -eq 143 ]; then code=3; fi
}

# Whether to start the worker again: it was killed (by the system for want of memory, by somebody), this task was not. A
# job that kills its worker again and again fails in the queue before the starts are used up.
killed() {
    [ -z "$reason" ] && [ "$code" -gt 128 ] || return 1
    if [ "$starts" -eq 0 ]; then
        say "the worker died again (code $code); giving up"
        return 1
    fi
    starts=$((starts - 1))
    say "the worker died (code $code) and is started again"
}

# What must not be half done: a signal to all children of the shell does not end it.
whole() { (trap '' TERM USR1 && exec "$@"); }

# Goes on in another time slot if the time limit came before the end of the work. Not after SIGTERM: whoever cancels a
# task means it, and what is pre-empted Slurm puts back itself. The task is named by array and index, because the number
# of one of the tasks is that of the array, and requeueing it would stop all the others.
go_on_later() {
    if [ "$reason" = limit ] && [ "$code" -eq 3 ]; then
        say "the time limit is near: going on in another time slot"
        scontrol requeue "${SLURM_ARRAY_JOB_ID}_${SLURM_ARRAY_TASK_ID}" \
            || say "cannot be put back into Slurm's queue; run submit.sh again for what is left"
    fi
}
