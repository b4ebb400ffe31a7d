# SPDX-License-Identifier: MIT
# A cape of 20 by 30 particles on a figure that runs and turns: processor time for 1/60 s versus the stretch of its
# columns (99th percentile over a minute), with more and more steps from right to left. Vertical lines: the stretches of
# the table. Leapfrog has steps of 0.9 of its stable step (0.5 where noted), and links as stiff as these steps allow.
# "tethers": tethers of every seventh row. "all tethers" and "no tethers" are in single precision. XPBD has rigid links.
# XPBD* is XPBD with a loop for regular sheets only. Where a point lies far above its curve, the cape clung to the
# figure in that run, with many particles in contact.
call system("dirname '".ARG0."'")."/style.gp" ARG1 ARG2 "leapfrog" "560 + key_height(9)"
cape = ARG3
call plots."need.gp" cape "solver precision tethers fraction effort time_us column_stretch"

is(solver, precision, tethers, fraction) = strcol("effort") eq "steps" && strcol("solver") eq solver && \
    strcol("precision") eq precision && strcol("tethers") eq tethers && abs(column("fraction") - fraction) < 0.01
cost(solver, precision, tethers, fraction) = is(solver, precision, tethers, fraction) ? column("time_us") : NaN

set datafile missing NaN
set logscale xy
set xrange [0.018:0.5]
set yrange [9:1500]
set xtics ("2 %%" 0.02, "3 %%" 0.03, "6 %%" 0.06, "10 %%" 0.1, "20 %%" 0.2, "40 %%" 0.4)
set ytics (10, 20, 50, 100, 200, 500, 1000)
set xlabel "stretch of a column"
set ylabel "time for 1/60 s / µs" offset 1,0
set arrow 1 from 0.03,9 to 0.03,1500 nohead linetype theory
set arrow 2 from 0.06,9 to 0.06,1500 nohead linetype theory
call plots."key.gp" 9
set output ARG1
plot cape using "column_stretch":(cost("leapfrog", "float", "rows", 0.9)) with linespoints linetype 3 linewidth 3 \
         title "float, tethers", \
     cape using "column_stretch":(cost("leapfrog", "float", "all", 0.9)) with linespoints linetype 6 title "all tethers", \
     cape using "column_stretch":(cost("leapfrog", "float", "none", 0.9)) with linespoints linetype 4 title "no tethers", \
     cape using "column_stretch":(cost("leapfrog", "double", "rows", 0.9)) with linespoints linetype 2 title "double, tethers", \
     cape using "column_stretch":(cost("leapfrog", "double", "none", 0.5)) with linespoints linetype 7 title "double, 0.5", \
     cape using "column_stretch":(cost("xpbd-mesh", "float", "none", 0)) with linespoints linetype 8 pointtype 6 title "XPBD", \
     cape using "column_stretch":(cost("xpbd-mesh", "float", "all", 0)) with linespoints linetype 8 dashtype (6,3) pointtype 4 title "XPBD, tethers", \
     cape using "column_stretch":(cost("xpbd-sheet", "float", "none", 0)) with linespoints linetype 5 pointtype 6 title "XPBD*", \
     cape using "column_stretch":(cost("xpbd-sheet", "float", "all", 0)) with linespoints linetype 5 dashtype (6,3) pointtype 4 title "XPBD*, tethers"
