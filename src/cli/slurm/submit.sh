
fail() {
    printf 'submit.sh: %s\n' "$*" >&2
    exit 2
}

# First of all, so that nothing is planned where nothing can run.
for command in sbatch squeue scancel; do
    command -v "$command" > /dev/null || fail "$command is not there: run this on a machine of the cluster that has Slurm's commands"
done
# Log files and what the jobs write go here, whatever folder this is called from.
cd -- "$folder" || fail "$folder is not there"
# An earlier array of these shards would work on the same files on other nodes, and the last one to end would win.
if [ -z "$db" ] && [ -e jobs ]; then
    read -r earlier _ < jobs
    # Slurm forgets jobs that ended some minutes ago; any other error is no proof that this one has.
    if ! alive=$(squeue --noheader --jobs="$earlier" 2>&1); then
        [[ "$alive" == *"Invalid job id"* ]] || fail "squeue does not tell whether array $earlier has ended: $alive"
        alive=
    fi
    [ -z "$alive" ] || fail "array $earlier of this folder has not ended: wait for it, or scancel $earlier"
fi
if [ -n "$db" ]; then
    "$tribosweep" submit --db "$db" -- "$study" || fail "the study was not planned, and nothing was submitted to Slurm"
else
    "$tribosweep" validate -- "$study" || fail "nothing was submitted to Slurm"
fi
array=$(sbatch --parsable workers.sbatch) || fail "sbatch took no workers, and nothing is submitted to Slurm"
# With the cluster's name behind it where there are several.
array=${array%%;*}
if ! report=$(sbatch --parsable --dependency="afterany:$array" report.sbatch); then
    scancel "$array" || fail "sbatch took no report, and array $array could not be taken back: scancel $array"
    fail "sbatch took no report; array $array was taken back, and nothing is submitted to Slurm"
fi
report=${report%%;*}
printf '%s %s\n' "$array" "$report" > jobs
printf 'workers: array %s with %s tasks\nreport:  job %s, after the array\n' "$array" "$workers" "$report"
printf '\nHow it goes:\n    squeue --jobs=%s,%s\n' "$array" "$report"
if [ -n "$db" ]; then
    printf '    %q status --db %q %q\n' "$tribosweep" "$db" "$name"
else
    printf '    tail -n 1 %q/%s_*.log\n' "$folder" "$array"
fi
printf 'What comes of it: %s and %s\n' "$folder/report/report.html" "$folder/jobs.csv"
