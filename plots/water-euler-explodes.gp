# SPDX-License-Identifier: MIT
# The same in steps of 2 ms, below leapfrog's stable step and RK4's. Euler explodes; the length is the largest height or
# depth, and what is beyond 10 cm has the colour of 10 cm. With the other two the wave runs as above.
call system("dirname '".ARG0."'")."/style.gp" ARG1 700
call plots."water-instants.gp" ARG1 ARG2 ARG3 ARG4 "16 32 48 64"
