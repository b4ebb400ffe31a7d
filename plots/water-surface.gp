# SPDX-License-Identifier: MIT
# A water surface in perspective, lit from one side: called by the animations of water, once, before they draw.

set pm3d depthorder interpolate 3,3 lighting primary 0.5 specular 0.3
set palette maxcolors 40 defined (-1 "#06264F", 0 "#3C8CC4", 1 "#E6F5FC")
unset colorbox
unset key
unset border
unset tics
unset grid
set autoscale fix
set xyplane 0
