
# SQLite's locks and shared memory do not work on network file systems: the database is on the local disk of the node, and
# only a closed file is copied between the node and the shared folder.
shard="shard-$SLURM_ARRAY_TASK_ID.db"
kept="$folder/shards/$shard"
# The name depends on the shared folder and not on the array, so that a task that was killed and runs on this node again,
# also in another array, finds its database.
node_folder="${SLURM_TMPDIR:-${TMPDIR:-/tmp}}/tribosweep-$(id -u)-$(printf %s "$folder" | cksum | cut -d ' ' -f 1)"
db="$node_folder/$shard"
mkdir -p -m 700 "$node_folder"
if [ ! -O "$node_folder" ] || ! mkdir -p "$folder/shards"; then
    say "$node_folder and $folder/shards must be folders that belong to you"
    exit 2
fi

plan() {
    uninterrupted "$tribosweep" submit --db "$db" --shard "$((SLURM_ARRAY_TASK_ID + 1))/$workers" ${replace:+"$replace"} -- "$study"
}

# Takes the newer one of the database on this node and the copy in the shared folder. A copy has the time of its original,
# so the clock of the file server does not matter. A killed worker leaves its last changes in the -wal file.
fetch_shard() {
    [ -e "$kept" ] || return 0
    if [ -e "$db" ] && ! { [ "$kept" -nt "$db" ] && [ "$kept" -nt "$db-wal" ]; }; then
        say "going on with what an earlier run left on this node"
        return 0
    fi
    say "going on with $kept"
    uninterrupted cp -p "$kept" "$db.partial" && rm -f "$db-wal" "$db-shm" && mv -f "$db.partial" "$db"
}

# Copies the closed database to the shared folder. The copy is complete or is not replaced.
store_shard() {
    # A worker that was killed did not close the database; opening it again does.
    [ ! -e "$db-wal" ] || plan
    if [ ! -e "$db-wal" ] && uninterrupted cp -p "$db" "$folder/shards/.$shard.partial" \
        && uninterrupted mv -f "$folder/shards/.$shard.partial" "$kept"; then
        return 0
    fi
    say "$db could not be copied to $kept; it stays on $(hostname)"
    return 1
}

say "worker for shard $((SLURM_ARRAY_TASK_ID + 1)) of $workers of $name on $(hostname)"
if ! fetch_shard || ! plan; then
    say "the shard was not planned; the lines above say why"
    exit 2
fi
while [ -z "$reason" ]; do
    # The worker stays in the process group of the shell, so that it gets the signals of Slurm. It ends at each interval, so
    # that the shard can be copied.
    run timeout --foreground "$keep_every" "$tribosweep" work --db "$db" --threads "$SLURM_CPUS_PER_TASK"
    if [ "$code" -eq 124 ]; then
        # `timeout` has ended the worker; its own exit code is not known.
        code=3
        store_shard
        continue
    fi
    restarts || break
done
say "the worker ended with $code"
if store_shard; then
    rm -f "$db" "$db.lock"
    requeue_at_limit
    exit "$code"
fi
requeue_at_limit
exit 2
