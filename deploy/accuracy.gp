# SPDX-License-Identifier: BSD-3-Clause
# Plots of docs/accuracy.md; deploy/accuracy.sh gives data (folder), images (folder), runs (number).
set encoding utf8
set grid
set terminal pngcairo size 900,480 font 'sans,10'

set output images.'/accuracy_along.png'
set title 'Error along the corridor: every seed, and twice the standard deviation that waymark claims (first seed)'
set xlabel 'driven [m]'
set ylabel 'estimate minus truth [m]'
set key outside right top
plot data.'/along.dat' index 0 using 1:(2*$7):(-2*$7) with filledcurves lc rgb '#dddddd' title '±2 sigma', \
  for [i=0:runs-1] '' index i using 1:3 with lines lw 1 notitle

set output images.'/accuracy_nees.png'
set title sprintf('Mean NEES over %d seeds at every metre; 3 is right', runs)
set ylabel 'NEES'
set yrange [0:*]
plot data.'/stations.dat' index 0 using 1:4:5 with filledcurves lc rgb '#dddddd' title '95 % band', \
  '' index 0 using 1:3 with linespoints pt 7 ps 0.5 lc rgb '#1f77b4' title 'waymark'
set yrange [*:*]

set output images.'/accuracy_ellipses.png'
set terminal pngcairo size 900,300 font 'sans,10'
set title 'Covariance along the path: 2-sigma ellipses, 20 times as large (first seed)'
set ylabel 'y [m]'
set xlabel 'x [m]'
set yrange [-1.5:1.5]
set style fill transparent solid 0.4
plot data.'/ellipses.dat' using 1:2:(20*$3):(20*$4):5 with ellipses units xy lc rgb '#1f77b4' notitle, \
  '' using 1:2 with linespoints pt 7 ps 0.4 lc rgb '#333333' notitle
set yrange [*:*]
set terminal pngcairo size 900,480 font 'sans,10'

set output images.'/accuracy_ablations.png'
set title 'ATE with parts left out: root mean square and worst of the seeds'
set style data histograms
set style histogram clustered gap 1
set style fill solid 0.8 noborder
unset xlabel
set ylabel 'ATE [m]'
set logscale y
set xtics rotate by -30 noenhanced
plot data.'/ablations.csv' using 2:xtic(1) title 'root mean square', '' using 3 title 'worst'
unset logscale y
set xtics norotate

if (system('[ -f '.data.'/length.dat ] && echo 1') eq '1') {
  set output images.'/accuracy_length.png'
  set title 'Error of the length of the way, synthetic sensors, root mean square'
  set xlabel 'corridor [m]'
  set ylabel 'error [m]'
  set logscale xy
  set xtics (25, 50, 100, 200)
  first = real(system('head -n 1 '.data.'/length.dat | cut -d " " -f 2'))
  plot data.'/length.dat' using 1:2 with linespoints pt 7 title 'waymark', \
    [25:200] first * (x / 25.0) ** 0.7 with lines dt 2 title 'length^{0.7}'
}
