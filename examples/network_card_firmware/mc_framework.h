/* mc_framework - what the card's firmware framework gives its programmer: names of a run task, of
 * the interrupt routines of buttons, and of programmable outputs. On a card these stand in its
 * library over FreeRTOS; here mc_framework.c stands for it, so that the project runs on a PC.
 */
#ifndef MC_FRAMEWORK_H
#define MC_FRAMEWORK_H

#include "mc_config.h"

/* Semaphores of the tasks: 0 or 1, so that a second give is lost. */
enum mc_semaphore { MC_SEM_RUN, MC_SEM_PAUSE, MC_SEM_STOP, MC_SEM_HOME, MC_SEMAPHORES };

/* Waits until the semaphore is given, and takes it. */
void mc_take(enum mc_semaphore which);

/* For an interrupt routine: gives the semaphore; *woken becomes 1 if that wakes a task. */
void mc_give_from_isr(enum mc_semaphore which, int *woken);

/* The last line of an interrupt routine: without it the woken task waits for the next tick. */
void mc_yield_from_isr(int woken);

/* A period of the DDA: pulses of each axis, and the number of an event at its begin; 0 is none. */
struct mc_frame {
    int pulses[4];
    int event;
};

/* The next frame of the job, which the storage task reads from flash; 0 behind the last. */
int mc_flash_read(struct mc_frame *frame);

/* Into the FPGA's buffer of MC_FIFO_DEPTH frames; waits while it is full. */
void mc_fpga_write(const struct mc_frame *frame);

/* A programmable output: how it is set when its flag is up. */
enum mc_po_mode { MC_PO_LEVEL, MC_PO_PULSE };

typedef struct {
    enum mc_po_mode mode;
    unsigned level;         /* MC_LEVEL_HIGH or MC_LEVEL_LOW; of a pulse, its active level */
    unsigned long width_us; /* of a pulse */
} MC_PO;

extern MC_PO mc_po[MC_OUTPUTS];
extern volatile unsigned char MC_PO_Pins[MC_OUTPUTS];

/* Its routine sets all outputs whose flag is up in one instant, and takes the flags down. */
void mc_software_interrupt(void);

/* Makes the six tasks, of which `run` is the programmer's, and starts them. */
int mc_start(void (*run)(void));

#endif
