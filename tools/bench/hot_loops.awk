# SPDX-License-Identifier: MIT
# Extracts the loops that tools/bench/instructions marks in an assembly file, as regions for llvm-mca. A region starts
# at the last label before a mark to which a branch after the mark jumps back, and ends with that branch.
#
# A region is named FUNCTION,THING,COUNT. An unrolled loop has several marks, whose counts are added. Marks outside of
# any loop (because the compiler found that it runs once) and marks in loops that are not innermost are omitted. With
# -v pattern=REGEX, only loops of functions with matching names are printed.

# Returns 1 if a loop contains another loop or a part of one.
function around_another(start, end, loops, from,   i) {
    for (i = 1; i <= loops; i++)
        if (start[i] <= end[from] && end[start[i]] >= from && !(start[i] <= from && end[from] <= end[start[i]]))
            return 1
    return 0
}

function flush_function(   m, l, b, best, from, to, i, loops, start, thing, count, end) {
    for (m = 1; m <= marks; m++) {
        best = 0
        for (b = mark[m]; b <= lines; b++) {
            if (!(b in goes_to) || !(goes_to[b] in label))
                continue
            l = label[goes_to[b]]
            if (l <= mark[m] && (best == 0 || b - l < best)) {
                best = b - l
                from = l
                to = b
            }
        }
        if (best == 0)
            continue
        if (!(from in count))
            start[++loops] = from
        end[from] = to
        thing[from] = what[m]
        count[from] += number[m]
    }
    for (i = 1; i <= loops; i++) {
        from = start[i]
        if (name !~ pattern || around_another(start, end, loops, from))
            continue
        print "# LLVM-MCA-BEGIN " name "," thing[from] "," count[from]
        for (l = from; l <= end[from]; l++)
            if (text[l] != "" && text[l] !~ /^[ \t]+(ret|call)/) # exits and rare paths, not part of a pass
                print text[l]
        print "# LLVM-MCA-END"
    }
    delete label
    delete goes_to
    lines = marks = 0
}

/^[A-Za-z_][A-Za-z0-9_.$]*:/ { # a function
    flush_function()
    name = $1
    sub(/[:.].*/, "", name)
    next
}
/^\.L[A-Za-z0-9_.$]*:/ {
    text[++lines] = $1 # for branches inside the loop
    sub(/:.*/, "", $1)
    label[$1] = lines
    next
}
/# hot loop:/ {
    mark[++marks] = ++lines
    text[lines] = ""
    what[marks] = $(NF - 1)
    number[marks] = $NF
    next
}
/^[ \t]+[a-z]/ {
    text[++lines] = $0
    if ($NF ~ /^\.L/)
        goes_to[lines] = $NF
}
END { flush_function() }
