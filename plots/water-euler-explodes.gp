# SPDX-License-Identifier: MIT
# The same in steps of 2 ms, below leapfrog's stable step and RK4's. Euler explodes; the length is the largest height or
# depth, and what is beyond 10 cm has the colour of 10 cm. With leapfrog and RK4 the wave runs as above.
call system("dirname '".ARG0."'")."/style.gp" ARG1 ARG2 "scenes" "95 + 148*methods"
call plots."water-instants.gp" ARG1 ARG3 "16 32 48 64"
