
report
