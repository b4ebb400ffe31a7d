# SPDX-License-Identifier: MIT
# The look of every figure: call it first, with the output file and, where 390 is not enough, the height in pixels.
#
#     call system("dirname '".ARG0."'")."/style.gp" ARG1
#
# An animation gives the height, and then the time of each of its frames in hundredths of a second.
#
# It chooses the terminal by the output's suffix, and sets plots, the folder of the scripts that figures share. A figure
# is 520 pixels wide with letters of 18: still legible when a phone shrinks it to 360.

plots = system("dirname '".ARG0."'")."/"
set encoding utf8
set datafile separator tab

width = 520
height = ARGC > 1 ? int(ARG2) : 390
suffix = ARG1[strstrt(ARG1, ".") > 0 ? strlen(ARG1) - 3 : 1 : *]
if (ARGC > 2) {
    if (suffix ne ".gif") {
        exit error "\"".ARG1."\": an animation is written to a file that ends in .gif"
    }
    set terminal gif animate delay int(ARG3) loop 0 optimize size width,height enhanced font "DejaVu Sans,13"
} else { if (suffix eq ".svg") {
    set terminal svg size width,height enhanced font "sans-serif,18" dashlength 0.7
} else { if (suffix eq ".png") {
    set terminal pngcairo size 2*width,2*height enhanced font "DejaVu Sans,13.5" fontscale 2 linewidth 2 pointscale 2
} else { if (suffix eq ".pdf") {
    set terminal pdfcairo size width/100.0,height/100.0 enhanced font "DejaVu Sans,12.5" linewidth 1
} else {
    exit error "\"".ARG1."\": a figure is written to a file that ends in .svg, .png or .pdf"
}}}}

# One line type a method, by its name: colour (Okabe and Ito's palette, told apart by colour-blind eyes), dash and marker.
# page.py reads these lines, for the page has other colours in the dark.
euler = 1
leapfrog = 2
rk4 = 3
exact = 4
theory = 5
grid = 6
page = 7
set linetype euler    linecolor rgb "#D55E00" linewidth 2.5 dashtype solid   pointtype 7  pointsize 0.8
set linetype leapfrog linecolor rgb "#0072B2" linewidth 2.5 dashtype (12,4)  pointtype 5  pointsize 0.8
set linetype rk4      linecolor rgb "#009E73" linewidth 2.5 dashtype (8,3,2,3) pointtype 9 pointsize 1
set linetype exact    linecolor rgb "#000000" linewidth 1.5 dashtype solid   pointtype 1
set linetype theory   linecolor rgb "#767676" linewidth 1.5 dashtype (3,3)   pointtype 2
set linetype grid     linecolor rgb "#D9D9D9" linewidth 0.5 dashtype solid
set linetype page     linecolor rgb "#FFFFFF"

set grid linetype grid
set border 3 linecolor rgb "#000000"
set tics nomirror scale 0.6
set key samplen 2.5 spacing 1.15
