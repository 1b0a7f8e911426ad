/* fpga_wires - the card's side of the link to its driver (fpga_link.h): what the driver has
 * published is taken over at an instant, and the card's state is shown to it. */
#ifndef FPGA_WIRES_H
#define FPGA_WIRES_H

#include "fpga.h"

/* Sequence numbers of the mailboxes taken last. */
struct fpga_taken {
    int32_t write_seq, out_seq, ao_seq, reset_seq;
};

/* Take over new mailboxes and the levels. Clocks must be finite and are rounded up to whole ones; 0
 * or less: none stated. */
void fpga_take(struct fpga_taken *taken, struct fpga *f, const struct fpga_host *host);

/* Show interrupts and the card's state to the driver. */
void fpga_show(const struct fpga *f, struct fpga_shown *shown);

#endif
