# SPDX-License-Identifier: MIT
# Colours of numbers from 10^LEAST to 10^MOST, for maps, and a bar that shows them; orange for larger ones.
#
#     call plots."cividis.gp" "LEAST" "MOST"
#
# Sets level(TEXT), what to draw for a number as it stands in a file, and beyond, the level of all that are too large.

# Logarithms, for a picture made of pixels has to have linear axes.
least = ARG1 + 0
most = ARG2 + 0
beyond = most + (most - least)/16.0
level(text) = text eq "inf" || text > 10**most ? beyond : text > 10**least ? log10(text) : least

# Cividis: even steps to the eye, colour-blind or not. No colour here is one of style.gp, which the page changes in the dark.
part(ninths) = least + (most - least)*ninths/9.0
set palette maxcolors 0 defined (part(0) "#00224E", part(1) "#123570", part(2) "#3B496C", part(3) "#575D6D", \
    part(4) "#707173", part(5) "#8A8678", part(6) "#A59C74", part(7) "#C3B369", part(8) "#E1CC55", most "#FEE838", \
    most "#D65E00", beyond "#D65E00")
set cbrange [least:beyond]
