# SPDX-License-Identifier: MIT
# Height-field water from above at four instants after a disturbance in the middle, in steps of {{
# step('water-2ms-euler-energy') }}, below the stable steps of leapfrog and RK4. Euler explodes: the largest height or
# depth is written below its panels.
call system("dirname '".ARG0."'")."/style.gp" ARG1 ARG2 "scenes" "95 + 148*methods"
call plots."water-instants.gp" ARG1 ARG3 "16 32 48 64"
