
say "worker for $name on $(hostname)"
while [ -z "$reason" ]; do
    run "$tribosweep" work --db "$db" --threads "$SLURM_CPUS_PER_TASK" --idle-exit "$idle_exit"
    restarts || break
done
say "the worker ended with $code"
requeue_at_limit
exit "$code"
