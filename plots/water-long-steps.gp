# SPDX-License-Identifier: MIT
# The same in steps of {{ step('water-3ms-euler-energy') }}, later: above leapfrog's stable step and below those of RK4,
# SRKN6 and RKN8, which hold. Where leapfrog's surface is still low, neighbours swing against each other already.
call system("dirname '".ARG0."'")."/style.gp" ARG1 ARG2 "scenes" "95 + 148*methods"
call plots."water-instants.gp" ARG1 ARG3 "40 80 120 160"
