# SPDX-License-Identifier: MIT
# Height-field water from above at four instants after a disturbance in the middle, in steps of {{
# step('water-fine-euler-energy') }}. The methods cannot be distinguished by eye. The wave travels to the edges, which
# are pinned.
call system("dirname '".ARG0."'")."/style.gp" ARG1 ARG2 "scenes" "95 + 148*methods"
call plots."water-instants.gp" ARG1 ARG3 "16 32 48 64"
