# SPDX-License-Identifier: MIT
# Bars with a name before and a number behind each: called by the figures of costs, which set
#
#     bars, titles[], colours[]   how many, from above; their names; their line types
#     is(r), size(r)              is this line of the file that of the r-th bar? Exactly one is; how long it is
#
#     call plots."bars.gp" FILE LEFT-MARGIN

set xrange [*:*]
set yrange [*:*]
longest = 0
array size_of[bars]
do for [r = 1:bars] {
    stats ARG1 using (is(r) ? (found = size(r), 1) : 0) nooutput
    if (STATS_sum != 1) {
        exit error sprintf("%s: %d rows for the bar %d, \"%s\"", ARG1, STATS_sum, r, titles[r])
    }
    size_of[r] = found
    longest = found > longest ? found : longest
}
set border 1
set lmargin at screen ARG2
set rmargin at screen 0.89
set grid noytics
set xrange [0:*]
unit = 10.0**floor(log10(longest))
set xtics longest < 2*unit ? 0.5*unit : longest < 4*unit ? unit : 2*unit # three or four, that have room
set yrange [-bars - 0.6:-0.4]
set ytics scale 0 ("" 0)
do for [r = 1:bars] {
    if (titles[r] ne " ") { set ytics add (titles[r] -r) }
}
unset key
set style fill solid noborder
x(r) = size_of[int(r)]
plot size_of using (x($1)):(-$1):(0):(x($1)):(-$1 - 0.38):(-$1 + 0.38):(colours[int($1)]) with boxxyerror linecolor variable, \
     size_of using (x($1)):(-$1):(sprintf("%.2g", x($1))) with labels left offset 0.3,0
