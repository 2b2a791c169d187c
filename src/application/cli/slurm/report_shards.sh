
# The database is on the local disk of the node, as in the tasks.
node_folder=$(mktemp -d "${SLURM_TMPDIR:-${TMPDIR:-/tmp}}/tribosweep-report.XXXXXX") || exit 2
trap 'rm -rf "$node_folder"' EXIT
db="$node_folder/$merged"
shards=()
for ((i = 0; i < workers; i++)); do
    [ -e "$folder/shards/shard-$i.db" ] || say "there is no shard-$i.db: its task has not ended"
done
# An earlier array may have had more tasks: all shards are merged.
for kept in "$folder"/shards/shard-*.db; do
    [ -e "$kept" ] || continue
    cp -p "$kept" "$node_folder/" || exit 2
    shards+=("$node_folder/${kept##*/}")
done
if [ "${#shards[@]}" -gt 0 ]; then
    "$tribosweep" merge --db "$db" -- "${shards[@]}" || exit 2
fi
# This adds the rows of shards that were never started.
"$tribosweep" submit --db "$db" ${replace:+"$replace"} -- "$study" || exit 2
if [ ! -e "$db-wal" ] && cp "$db" "$folder/.$merged.partial"; then
    mv -f "$folder/.$merged.partial" "$folder/$merged" || exit 2
else
    say "the merged database could not be copied to $folder"
    exit 2
fi
report
