/* mc_framework - a stand-in for the card's framework on a PC: one start, a job of a second in which
 * the pause button is pressed twice, no time and no pre-emption. It prints what the card would do.
 */
#include "mc_framework.h"

#include <stdio.h>
#include <stdlib.h>

enum { FRAMES = 1000, PEN_DOWN = 100, PRESSED = 500, PEN_UP = 900 };

void EXTI3_IRQHandler(void);

MC_PO mc_po[MC_OUTPUTS];
volatile unsigned char MC_PO_Pins[MC_OUTPUTS];

static int given[MC_SEMAPHORES];
static int next_frame;
static long written, position[4];

static void give(enum mc_semaphore which)
{
    if (given[which]) {
        printf("frame %d: semaphore %d is full: this give is lost\n", next_frame, (int)which);
    }
    given[which] = 1;
}

void mc_take(enum mc_semaphore which)
{
    if (!given[which]) { /* nobody is there to give it any more */
        printf("%ld frames, X %ld, Y %ld pulses\n", written, position[0], position[1]);
        exit(0);
    }
    given[which] = 0;
}

void mc_give_from_isr(enum mc_semaphore which, int *woken)
{
    *woken = !given[which];
    give(which);
}

void mc_yield_from_isr(int woken)
{
    printf("frame %d: %s\n", next_frame, woken ? "the pause task gets the processor" : "no task");
}

int mc_flash_read(struct mc_frame *frame)
{
    int k = next_frame;

    if (k == FRAMES) {
        return 0;
    }
    if (k == PRESSED) {
        EXTI3_IRQHandler();
        EXTI3_IRQHandler();
    }
    frame->pulses[0] = 100;
    frame->pulses[1] = k < FRAMES / 2 ? 50 : -50;
    frame->pulses[2] = frame->pulses[3] = 0;
    frame->event = k == PEN_DOWN ? 1 : k == PEN_UP ? 2 : 0;
    next_frame++;
    return 1;
}

void mc_fpga_write(const struct mc_frame *frame)
{
    int i;

    for (i = 0; i < 4; i++) {
        position[i] += frame->pulses[i];
    }
    written++;
}

void mc_software_interrupt(void)
{
    unsigned pin;

    printf("frame %d:", next_frame - 1);
    for (pin = 0; pin < MC_OUTPUTS; pin++) {
        if (MC_PO_Pins[pin] && mc_po[pin].mode == MC_PO_PULSE) {
            printf(" output %u pulse %lu us", pin, mc_po[pin].width_us);
        } else if (MC_PO_Pins[pin]) {
            printf(" output %u %s", pin, mc_po[pin].level == MC_LEVEL_HIGH ? "high" : "low");
        }
        MC_PO_Pins[pin] = 0;
    }
    printf("\n");
}

int mc_start(void (*run)(void))
{
    printf("card %lu at %u.%u.%u.%u, server %u.%u.%u.%u:%u\n", MC_CARD_ID, MC_IP_0, MC_IP_1,
           MC_IP_2, MC_IP_3, MC_SERVER_IP_0, MC_SERVER_IP_1, MC_SERVER_IP_2, MC_SERVER_IP_3,
           MC_SERVER_PORT);
    give(MC_SEM_RUN);
    run();
    return 1;
}
