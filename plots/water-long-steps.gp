# SPDX-License-Identifier: MIT
# The same in steps of 3.33 ms, later: above leapfrog's stable step and below those of RK4 and RKN8, which hold. At 40 ms
# leapfrog's surface is still lower than the 1 m from which on we call it exploded; neighbours swing against each other.
call system("dirname '".ARG0."'")."/style.gp" ARG1 ARG2 "scenes" "95 + 148*methods"
call plots."water-instants.gp" ARG1 ARG3 "40 80 120 160"
