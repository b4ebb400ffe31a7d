# SPDX-License-Identifier: MIT
# The loops of an assembly file that tools/bench/instructions marks, as regions for llvm-mca: from the last label
# before a mark that a branch behind it goes back to, up to that branch. Called by tools/bench/instructions.
#
# A region is called FUNCTION,THING,COUNT; the compiler may have unrolled the loop: then it has several marks, whose
# counts add up. A mark in no loop any more, where the compiler knows that it runs once, is left out, and so is one whose
# loop is not the innermost. With -v pattern=REGEX only those of functions with such names are printed.

# Does a loop hold another, or a part of it?
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
            if (text[l] != "" && text[l] !~ /^[ \t]+(ret|call)/) # where the loop is left, or what is rare: not in its passes
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
    text[++lines] = $1 # for branches inside
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
