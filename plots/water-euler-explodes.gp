# SPDX-License-Identifier: MIT
# Water from above at four instants after it was poked in the middle, in steps of {{ step('water-2ms-euler-energy') }},
# below leapfrog's stable step and RK4's. Euler explodes: below its cells stands the largest height or depth.
call system("dirname '".ARG0."'")."/style.gp" ARG1 ARG2 "scenes" "95 + 148*methods"
call plots."water-instants.gp" ARG1 ARG3 "16 32 48 64"
