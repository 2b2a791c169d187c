
fail() {
    printf 'submit.sh: %s\n' "$*" >&2
    exit 2
}

# This is checked first, so that nothing is planned where nothing can run.
for command in sbatch squeue scancel; do
    command -v "$command" > /dev/null || fail "$command is not there: run this on a machine of the cluster that has Slurm's commands"
done
# Log files and results go into this folder, whatever the current folder is.
cd -- "$folder" || fail "$folder is not there"
# An earlier array would work on the same shards on other nodes, and the last one to end would overwrite the others.
if [ -z "$db" ] && [ -e jobs ]; then
    read -r earlier _ < jobs
    # Slurm forgets jobs some minutes after their end. Any other error does not prove that the array has ended.
    if ! alive=$(squeue --noheader --jobs="$earlier" 2>&1); then
        [[ "$alive" == *"Invalid job id"* ]] || fail "squeue does not tell whether array $earlier has ended: $alive"
        alive=
    fi
    [ -z "$alive" ] || fail "array $earlier of this folder has not ended: wait for it, or scancel $earlier"
fi
if [ -n "$db" ]; then
    "$tribosweep" submit --db "$db" ${replace:+"$replace"} -- "$study" || fail "the study was not planned, and nothing was submitted to Slurm"
else
    "$tribosweep" validate -- "$study" || fail "nothing was submitted to Slurm"
fi
array=$(sbatch --parsable workers.sbatch) || fail "sbatch refused the workers, and nothing is submitted to Slurm"
# With several clusters the name of the cluster follows.
array=${array%%;*}
if ! report=$(sbatch --parsable --dependency="afterany:$array" report.sbatch); then
    scancel "$array" || fail "sbatch refused the report, and array $array could not be cancelled: run scancel $array"
    fail "sbatch refused the report; array $array was cancelled, and nothing is submitted to Slurm"
fi
report=${report%%;*}
printf '%s %s\n' "$array" "$report" > jobs
printf 'workers: array %s with %s tasks\nreport:  job %s, after the array\n' "$array" "$workers" "$report"
printf '\nProgress:\n    squeue --jobs=%s,%s\n' "$array" "$report"
if [ -n "$db" ]; then
    printf '    %q status --db %q %q\n' "$tribosweep" "$db" "$name"
else
    printf '    tail -n 1 %q/%s_*.log\n' "$folder" "$array"
fi
printf 'Results: %s and %s\n' "$folder/report/report.html" "$folder/jobs.csv"
