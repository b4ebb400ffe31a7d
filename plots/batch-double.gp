# SPDX-License-Identifier: MIT
# Time of one step of one spring in a batch in double precision versus the number of springs, for one step per call and
# for many. The dotted lines, in the colour of the method, are the limits. The limit for one step per call is the time
# of a kernel that only reads and writes the same memory. It rises when the springs no longer fit into a cache. The
# limit for many steps is the time of a kernel that only does the arithmetic.
call system("dirname '".ARG0."'")."/style.gp" ARG1 ARG2 "rk4 leapfrog" "390 + key_height(5)"
call plots."batch-precision.gp" ARG1 ARG3 double
