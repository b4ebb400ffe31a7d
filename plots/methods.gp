# SPDX-License-Identifier: MIT
# The methods a figure shows, from the table that the library itself gives: called by style.gp.
#
#     call plots."methods.gp" TABLE WHICH      springs, scenes: every stepper for these; all: every row of the table;
#                                              or some by their names: "leapfrog rk4"
#
# Sets methods, how many there are, and of the m-th of them names[m], labels[m], orders[m], forces[m] (a step),
# symplectic[m] and types[m], its line type, which goes by its place in the table, whatever a figure leaves out.
# linetype_of(name) and label_of(name) find a method by its name, chosen or not. file(list, m) is the m-th of a list of files.

call plots."need.gp" ARG1 "method label order forces_per_step symplectic springs scenes"
which = ARG2
stats ARG1 using "order" nooutput
array all_names[STATS_records]
array all_labels[STATS_records]
array all_types[STATS_records]
array names[STATS_records]
array labels[STATS_records]
array orders[STATS_records]
array forces[STATS_records]
array symplectic[STATS_records]
array types[STATS_records]
place = 0
methods = 0
looks = 0
chosen(which) = which eq "all" ? 1 : which eq "springs" || which eq "scenes" ? column("order") > 0 && column(which) == 1 \
    : sum [w=1:words(which)] (word(which, w) eq strcol("method"))
look(name) = name eq "exact" ? exact : (looks = looks + 1)
show(place) = (methods = methods + 1, names[methods] = all_names[place], labels[methods] = all_labels[place], \
    types[methods] = all_types[place], orders[methods] = column("order"), forces[methods] = column("forces_per_step"), \
    symplectic[methods] = column("symplectic") == 1, 0)
note(name) = name eq "method" ? NaN : (place = place + 1, all_names[place] = name, all_labels[place] = strcol("label"), \
    all_types[place] = look(name), chosen(which) ? show(place) : 0) # strcol() sees the header line, too
stats ARG1 using (note(strcol("method"))) nooutput

if (looks >= exact) {
    exit error sprintf("%s: %d methods besides the exact solution, style.gp has %d line types", ARG1, looks, exact - 1)
}
place_of(name) = sum [p=1:place] (all_names[p] eq name ? p : 0)
linetype_of(name) = all_types[place_of(name)]
label_of(name) = all_labels[place_of(name)]
file(list, m) = word(list, int(m))
