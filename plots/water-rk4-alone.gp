# SPDX-License-Identifier: MIT
# The same in steps of 3.33 ms, later: above leapfrog's stable step and below RK4's. RK4 holds alone. At 40 ms
# leapfrog's surface is still lower than the 1 m from which on we call it exploded; neighbours swing against each other.
call system("dirname '".ARG0."'")."/style.gp" ARG1 700
call plots."water-instants.gp" ARG1 ARG2 ARG3 ARG4 "40 80 120 160"
