# SPDX-License-Identifier: MIT
# Euler: the error after one second against the number of steps, and the power law fitted through all of the points.
call system("dirname '".ARG0."'")."/style.gp" ARG1
call plots."order-method.gp" ARG1 ARG2 ARG3 euler
