# SPDX-License-Identifier: MIT
# What one step of one link costs in a sheet, against the number of links: in natural order, where links lie in rows, and
# with links and particles in random order. Grey: the plain loop over a list of links, which anybody would write, on the
# same sheets. Dotted: the limit, the slower of two kernels that only do the arithmetic or only move the memory.
call system("dirname '".ARG0."'")."/style.gp" ARG1 ARG2 "leapfrog" 540
call plots."need.gp" ARG3 "kernel precision count ns_per_spring_step limit_ns baseline_ns"
bench = ARG3

is(kernel) = strcol("kernel") eq kernel && strcol("precision") eq "double"
count(kernel) = is(kernel) ? column("count") : NaN
other = 1 # the look of another method

set datafile missing NaN # joins the points of a kernel whose rows are not neighbours
set logscale xy
set xrange [400:7e6]
set yrange [0.3:100]
set format x "10^{%T}"
set xlabel "links"
set ylabel "time / (ns per link and step)"
set ytics (0.5, 1, 2, 5, 10, 20, 50, 100)
set key tmargin left Left reverse vertical maxrows 6
set output ARG1
plot bench using (count("leapfrog_sheet_1_shuffled")):"ns_per_spring_step" with linespoints linetype other \
         title "random order", \
     "" using (count("leapfrog_sheet_1_shuffled")):"baseline_ns" with linespoints linetype theory dashtype (3,3) \
         pointtype 6 pointsize 1.2 title "random order, plain loop", \
     "" using (count("leapfrog_sheet_1")):"baseline_ns" with linespoints linetype theory dashtype solid pointtype 4 \
         pointsize 1.2 title "natural order, plain loop", \
     "" using (count("leapfrog_sheet_1")):"ns_per_spring_step" with linespoints linetype types[1] dashtype solid \
         title "natural order, one step a call", \
     "" using (count("leapfrog_sheet_16")):"ns_per_spring_step" with linespoints linetype types[1] dashtype solid \
         pointtype 4 pointsize 1.2 title "natural order, 16 steps a call", \
     "" using (count("leapfrog_sheet_1")):"limit_ns" with lines linetype types[1] linewidth 2 dashtype (2,3) \
         title "limit, natural order"
