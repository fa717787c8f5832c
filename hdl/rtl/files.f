// Files of a level depend on those of former levels only.
// level 0
accelerator_pkg.sv
stream_pkg.sv
// level 1
delay.sv
stream_fifo.sv
line_taps.sv
word_window.sv
operators.sv
vote_memory.sv
angle_classes.sv
// level 2
gaussian.sv
gradient.sv
suppression.sv
hysteresis.sv
angle_votes.sv
angle_votes_shared.sv
edge_queue.sv
peak_scan.sv
// level 3
video_input.sv
canny.sv
hough_parallel.sv
hough_shared.sv
line_packet.sv
control_registers.sv
// level 4
accelerator.sv
