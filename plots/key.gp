# SPDX-License-Identifier: MIT
# Puts the key above the picture, in two columns, and the picture below it, whatever the number of its entries.
#
#     call plots."key.gp" ENTRIES
#
# The height of a figure has to make room for it: "390 + key_height(methods)".

set key at screen 0.02,1 - 4.0/height left top vertical Left reverse samplen 2 maxrows (int(ARG1) + 1)/2
set tmargin at screen key_bottom(int(ARG1))
