# SPDX-License-Identifier: MIT
# What one step of one spring costs in a batch of single precision, against the number of springs, for one step a call
# and for many. Dotted, in the colour of the method: the limit, as above.
call system("dirname '".ARG0."'")."/style.gp" ARG1 ARG2 "rk4 leapfrog" "390 + key_height(5)"
call plots."batch-precision.gp" ARG1 ARG3 float
