/* fpga_wires - the card on the link: what a driver has published is taken at an instant, what the
 * card shows it. */
#ifndef FPGA_WIRES_H
#define FPGA_WIRES_H

#include "fpga.h"

/* Numbers of the mailboxes taken last. */
struct fpga_taken {
    int32_t write_seq, out_seq, ao_seq, reset_seq;
};

/* Take new mailboxes and the levels. Clocks are finite, rounded up to whole ones; below 0: none
 * stated. */
void fpga_take(struct fpga_taken *taken, struct fpga *f, const struct fpga_host *host);

void fpga_show(const struct fpga *f, struct fpga_shown *shown);

#endif
