#!/bin/sh
# Filters `asperity check`: each worst deviation becomes the power of ten above it. The last digits
# may depend on the C library's elementary functions, which differ from one processor to the next.
exec awk '
    NR == 1 { print; next }
    $1 == "law" { printf "  %-18s %9s %9s   %s\n", "law", "checks", "worst <", "unit"; next }
    NF >= 6 && ($5 == "holds" || $5 == "BROKEN") {
        unit = $6
        for (i = 7; i <= NF; i++)
            unit = unit " " $i
        if ($3 == 0)
            worst = "0"
        else if (unit ~ /log10/)
            worst = $4
        else {
            e = log($3) / log(10)
            e = e == int(e) ? e : e > 0 ? int(e) + 1 : int(e)
            worst = sprintf("1e%d", e)
        }
        printf "  %-18s %9d %9s   %s\n", $1, $2, $5 == "holds" ? worst : $5, unit
    }'
