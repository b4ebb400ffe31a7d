# SPDX-License-Identifier: MIT
# Error at the end of a run with contacts versus step, for the library and for two schemes that are common in engines,
# all with leapfrog. Top: a particle bounces along the ground with friction (case oblique of spring-contacts). Bottom: a
# particle slides down a sphere with friction (case sphere). The dotted lines have the slopes of orders one and two. The
# errors of bounces also depend on where within a step an impact occurs.
call system("dirname '".ARG0."'")."/style.gp" ARG1 ARG2 "leapfrog" "760 + key_height(4)"
contacts = ARG3
call plots."need.gp" contacts "case scheme dt_s error"

array schemes[3] = ["library", "projection", "penalty"]
array titles[3] = ["springstep", "projection", "penalty"]
array kinds[3] = [3, 1, 4]
panel = ""
error(scheme) = strcol("case") eq panel && strcol("scheme") eq scheme ? column("error") : NaN

set datafile missing NaN
set logscale xy
set format xy "10^{%T}"
set xrange [1e-4:6e-3]
set xtics 10
set mytics 1
set ytics 100
set ylabel "error in position / m" offset 1.5,0
call plots."key.gp" 4
set output ARG1
set multiplot layout 2,1 margins 0.2,0.94,82.0/height,key_bottom(4) - 40.0/height spacing 84.0/height
set yrange [1e-10:1]
panel = "oblique"
set title "bounces" offset 0,-0.6
plot 1.2*x with lines linetype theory notitle, 0.05*x**2 with lines linetype theory notitle, \
     for [s = 1:3] contacts using "dt_s":(error(schemes[s])) with linespoints linetype kinds[s] linewidth 2 title titles[s], \
     NaN with lines linetype theory title "orders 1, 2"
unset key
set xlabel "step / s"
panel = "sphere"
set title "sliding down a sphere" offset 0,-0.6
plot 0.4*x with lines linetype theory notitle, 0.5*x**2 with lines linetype theory notitle, \
     for [s = 1:3] contacts using "dt_s":(error(schemes[s])) with linespoints linetype kinds[s] linewidth 2 title titles[s]
unset multiplot
