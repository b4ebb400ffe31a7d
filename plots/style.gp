# SPDX-License-Identifier: MIT
# The look of every figure, and its methods: call it first, with the output file, the table of the methods, which of
# them the figure shows (see methods.gp) and, where 390 is not enough, the height in pixels, an expression that may
# depend on the number of methods.
#
#     call system("dirname '".ARG0."'")."/style.gp" ARG1 ARG2 "springs" "390 + key_height(methods)"
#
# It chooses the terminal by the output's suffix, and sets plots, the folder of the scripts that figures share. A figure
# is 520 pixels wide with letters of 18: still legible when a phone shrinks it to 360.

plots = system("dirname '".ARG0."'")."/"
set encoding utf8
set datafile separator tab

# One line type a method, by its place in the table: colour (Okabe and Ito's palette, told apart by colour-blind eyes,
# its yellow darkened to be seen on white), dash and marker. The exact solution is black wherever it stands.
# page.py reads these lines, for the page has other colours in the dark.
exact = 8
theory = 9
grid = 10
page = 11
gsl = 12
sundials = 13
odeint = 14
set linetype 1      linecolor rgb "#D55E00" linewidth 2.5 dashtype solid          pointtype 7  pointsize 0.8
set linetype 2      linecolor rgb "#CC79A7" linewidth 2.5 dashtype (16,3)         pointtype 13 pointsize 1
set linetype 3      linecolor rgb "#0072B2" linewidth 2.5 dashtype (12,4)         pointtype 5  pointsize 0.8
set linetype 4      linecolor rgb "#009E73" linewidth 2.5 dashtype (8,3,2,3)      pointtype 9  pointsize 1
set linetype 5      linecolor rgb "#E69F00" linewidth 2.5 dashtype (5,3)          pointtype 11 pointsize 1
set linetype 6      linecolor rgb "#56B4E9" linewidth 2.5 dashtype (12,3,2,3,2,3) pointtype 15 pointsize 0.9
set linetype 7      linecolor rgb "#A89A00" linewidth 2.5 dashtype (8,3,5,3)      pointtype 3  pointsize 0.9
set linetype exact  linecolor rgb "#000000" linewidth 1.5 dashtype solid          pointtype 1
set linetype theory linecolor rgb "#767676" linewidth 1.5 dashtype (3,3)          pointtype 2
set linetype grid   linecolor rgb "#D9D9D9" linewidth 0.5 dashtype solid
set linetype page   linecolor rgb "#FFFFFF"
# External solvers, by their library: an open marker each, see externals.gp.
set linetype gsl      linecolor rgb "#5F6F7A" linewidth 1.5 dashtype solid
set linetype sundials linecolor rgb "#8A5A3C" linewidth 1.5 dashtype (6,3)
set linetype odeint   linecolor rgb "#7B4FA3" linewidth 1.5 dashtype (9,3,2,3)

call plots."methods.gp" ARG2 ARG3

width = 520
height = 390
key_height(entries) = 31*((entries + 1)/2) + 6 # [px] of a key above the picture, see key.gp, and of a gap below it
key_bottom(entries) = 1 - (20.0 + key_height(entries))/height
if (ARGC > 3) {
    eval "height = int(".ARG4.")"
}
suffix = ARG1[strstrt(ARG1, ".") > 0 ? strlen(ARG1) - 3 : 1 : *]
if (suffix eq ".svg") {
    set terminal svg size width,height enhanced font "sans-serif,18" dashlength 0.7
} else { if (suffix eq ".png") {
    set terminal pngcairo size 2*width,2*height enhanced font "DejaVu Sans,13.5" fontscale 2 linewidth 2 pointscale 2
} else { if (suffix eq ".pdf") {
    set terminal pdfcairo size width/100.0,height/100.0 enhanced font "DejaVu Sans,12.5" linewidth 1
} else {
    exit error "\"".ARG1."\": a figure is written to a file that ends in .svg, .png or .pdf"
}}}

set grid linetype grid
set border 3 linecolor rgb "#000000"
set tics nomirror scale 0.6
set key samplen 2.5 spacing 1.15
