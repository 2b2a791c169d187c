
# SQLite's locks and shared memory do not work on network file systems: the database is on the node's own disk, and only
# a closed file is ever copied between there and the shared folder.
shard="shard-$SLURM_ARRAY_TASK_ID.db"
kept="$folder/shards/$shard"
# Called by the shared folder and not by the array, so that a task which was killed outright and comes back to this node,
# be it in another array, finds what it left.
node_folder="${SLURM_TMPDIR:-${TMPDIR:-/tmp}}/tribosweep-$(id -u)-$(printf %s "$folder" | cksum | cut -d ' ' -f 1)"
db="$node_folder/$shard"
mkdir -p -m 700 "$node_folder"
if [ ! -O "$node_folder" ] || ! mkdir -p "$folder/shards"; then
    say "$node_folder and $folder/shards must be folders of yours to work in"
    exit 2
fi

plan() { whole "$tribosweep" submit --db "$db" --shard "$((SLURM_ARRAY_TASK_ID + 1))/$workers" -- "$study"; }

# The newer of what is on this node and what was kept. Copies have the time of what they are copies of, so that the clock of
# the file server does not matter; a killed worker leaves its last changes in the -wal file.
take_up() {
    [ -e "$kept" ] || return 0
    if [ -e "$db" ] && ! { [ "$kept" -nt "$db" ] && [ "$kept" -nt "$db-wal" ]; }; then
        say "going on with what an earlier run left on this node"
        return 0
    fi
    say "going on with $kept"
    whole cp -p "$kept" "$db.partial" && rm -f "$db-wal" "$db-shm" && mv -f "$db.partial" "$db"
}

# Copies the closed database to the shared folder, whole or not at all.
keep() {
    # A worker that was killed did not close it; whoever opens it next does.
    [ ! -e "$db-wal" ] || plan
    if [ ! -e "$db-wal" ] && whole cp -p "$db" "$folder/shards/.$shard.partial" \
        && whole mv -f "$folder/shards/.$shard.partial" "$kept"; then
        return 0
    fi
    say "$db could not be copied to $kept; it stays on $(hostname)"
    return 1
}

say "worker for shard $((SLURM_ARRAY_TASK_ID + 1)) of $workers of $name on $(hostname)"
if ! take_up || ! plan; then
    say "the shard cannot be taken up"
    exit 2
fi
while [ -z "$reason" ]; do
    # In the foreground of the shell's group, so that Slurm finds it; a node that dies costs what was not kept.
    run timeout --foreground "$keep_every" "$tribosweep" work --db "$db" --threads "$SLURM_CPUS_PER_TASK"
    if [ "$code" -eq 124 ]; then
        # `timeout` says so whatever the worker made of it, so that is all there is to know until it is asked again.
        code=3
        keep
        continue
    fi
    killed || break
done
say "the worker ended with $code"
if keep; then
    rm -f "$db" "$db.lock"
    go_on_later
    exit "$code"
fi
go_on_later
exit 2
