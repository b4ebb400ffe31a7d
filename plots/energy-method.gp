# SPDX-License-Identifier: MIT
# {{ method }}: the error in energy against the time run. Grey: the law, where the text gives one.
call system("dirname '".ARG0."'")."/style.gp" ARG1 ARG2 ARG3 "390 + key_height(4)"
synchronised = ARG4
ahead = ARGC > 4 ? ARG5 : "" # with the velocity half a step ahead
call plots."need.gp" synchronised "duration_s steps energy_error_J" 1
call plots."need.gp" ahead "duration_s energy_error_J"
stats synchronised using (column("duration_s")/column("steps")) nooutput
dt = STATS_mean

E0 = 0.5
method = names[1]
type = types[1]
infinite = 1e60 # and what is more
measured(y) = y < infinite ? y : NaN
overflow(y) = y < infinite ? NaN : infinite/1e3
overflows = 0
least = infinite
most = 0
extremes(y) = (overflows = overflows + (y >= infinite), most = y < infinite && y > most ? y : most, \
    least = y > 0 && y < least ? y : least, 0)
do for [energies in synchronised." ".ahead] {
    stats energies using (extremes(column("energy_error_J"))) nooutput
}

gain(t) = t < log(infinite/E0)/log(1 + dt**2)*dt ? E0*((1 + dt**2)**(t/dt) - 1) : NaN
loss(t) = E0*(1 - exp(-t/dt*dt**6/72))
law(t) = method eq "euler" ? gain(t) : method eq "rk4" ? loss(t) : method eq "leapfrog" ? E0*dt**2/4 : NaN
law_title = method eq "euler" ? "½((1 + z²)^n − 1)" : method eq "rk4" ? "E_0 n z⁶/72" : method eq "leapfrog" ? "E_0 z²/4" : ""
scatter = ahead ne "" ? E0*dt/2 : NaN

set logscale xy
set xrange [0.5:2e8]
set yrange [10.0**floor(log10(least) - 1):overflows ? infinite : 10.0**ceil(log10(most) + 1)]
set xlabel "time run / s"
set ylabel "error in energy / J"
set format xy "10^{%T}"
set xtics 100
set mxtics 1
set mytics 1
call plots."key.gp" 4
set output ARG1
plot law(x) with lines linetype theory title law_title, \
     synchronised using "duration_s":(measured(column("energy_error_J"))) with points linetype type pointsize 1.2 \
         title ahead ne "" ? "synchronised" : "measured", \
     synchronised using "duration_s":(overflow(column("energy_error_J"))) with points linetype type pointtype 8 pointsize 1.5 \
         title overflows ? "infinite" : "", \
     scatter with lines linetype theory dashtype (1,3) title ahead ne "" ? "E_0 z/2" : "", \
     for [energies in ahead] energies using "duration_s":"energy_error_J" with points linetype type pointtype 4 pointsize 1.2 \
         title "half a step ahead"
