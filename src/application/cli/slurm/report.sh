
say() { printf '%s report: %s\n' "$(date +%FT%T)" "$*"; }

# Writes the report and the export, and ends with an exit code for the state of the study.
report() {
    "$tribosweep" report --db "$db" --out "$folder/report" -- "$name" || exit 2
    "$tribosweep" export --db "$db" --csv "$folder/jobs.csv" -- "$name" || exit 2
    "$tribosweep" status --db "$db" -- "$name"
    counts=$("$tribosweep" status --db "$db" --json -- "$name" | tr -d ' \n' | sed 's/.*"jobs":{\([^}]*\)}.*/\1/')
    if [ "$(count pending)" -gt 0 ] || [ "$(count running)" -gt 0 ]; then
        say "the study is not finished, and the report lists the missing jobs; $folder/submit.sh continues it"
        exit 3
    fi
    [ "$(count failed)" -eq 0 ] || exit 1
    exit 0
}

count() { printf '%s' "$counts" | sed "s/.*\"$1\":\([0-9]*\).*/\1/"; }
