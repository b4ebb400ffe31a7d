# SPDX-License-Identifier: MIT
# Says what a data file lacks: the first of the given columns that is not there or holds no value. Nothing if all is well.

BEGIN {
    FS = "\t"
    wanted = split(columns, want, " ")
}

/^#/ || NF == 0 {
    next
}

!header {
    for (i = 1; i <= NF; i++)
        at[$i] = i
    header = 1
    next
}

{
    for (i = 1; i <= wanted; i++)
        if (want[i] in at && $at[want[i]] ~ /./)
            found[want[i]] = 1
}

END {
    for (i = 1; i <= wanted; i++)
        if (!(want[i] in found)) {
            print (want[i] in at ? "no value in column " : "no column ") "\"" want[i] "\""
            exit
        }
}
