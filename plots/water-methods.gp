# SPDX-License-Identifier: MIT
# The water from above at four instants after it was poked in the middle, in steps of {{ step('water-fine-euler-energy')
# }}: the methods agree to the eye. The wave runs to the edges, which are held.
call system("dirname '".ARG0."'")."/style.gp" ARG1 ARG2 "scenes" "95 + 148*methods"
call plots."water-instants.gp" ARG1 ARG3 "16 32 48 64"
