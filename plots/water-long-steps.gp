# SPDX-License-Identifier: MIT
# The same water in steps of {{ step('water-3ms-euler-energy') }}, at later times. This step is above leapfrog's stable
# step and below the stable steps of RK4, SRKN6 and RKN8, which remain stable. Where leapfrog's surface is still low,
# neighbouring particles already oscillate in opposite directions.
call system("dirname '".ARG0."'")."/style.gp" ARG1 ARG2 "scenes" "95 + 148*methods"
call plots."water-instants.gp" ARG1 ARG3 "40 80 120 160"
