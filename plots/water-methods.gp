# SPDX-License-Identifier: MIT
# The water from above at four instants after it was poked in the middle, in steps of 0.01 ms: the methods agree to the
# eye. The poke lasts 20 ms; after 32 ms its wave is at the edges, which are held. In the middle at first it is deeper
# than 10 cm.
call system("dirname '".ARG0."'")."/style.gp" ARG1 ARG2 "scenes" "95 + 148*methods"
call plots."water-instants.gp" ARG1 ARG3 "16 32 48 64"
