/* plotter - what a programmer of the card writes: the run task and a button's interrupt routine. */
#include "mc_framework.h"

#if MC_IN_3_ACTION != MC_ACTION_PAUSE
#error "the pause button is wired to input 3"
#endif

void EXTI3_IRQHandler(void);

/* Input 3: the button gives the semaphore of the pause task, which is more urgent than run. */
void EXTI3_IRQHandler(void)
{
    int woken = 0;

    mc_give_from_isr(MC_SEM_PAUSE, &woken);
    mc_yield_from_isr(woken);
}

/* Pen and valve switch together: both flags are up when the routine comes. */
static void pen(int down)
{
    mc_po[MC_OUT_PEN].mode = MC_PO_LEVEL;
    mc_po[MC_OUT_PEN].level = down ? MC_LEVEL_HIGH : MC_LEVEL_LOW;
    MC_PO_Pins[MC_OUT_PEN] = 1;
    if (down) {
        mc_po[MC_OUT_VALVE].mode = MC_PO_PULSE;
        mc_po[MC_OUT_VALVE].level = MC_LEVEL_HIGH;
        mc_po[MC_OUT_VALVE].width_us = MC_PEN_DWELL_US;
        MC_PO_Pins[MC_OUT_VALVE] = 1;
    }
    mc_software_interrupt();
}

/* Reads the job frame by frame and hands it to the FPGA, once for each start. */
static void run(void)
{
    struct mc_frame frame;

    for (;;) {
        mc_take(MC_SEM_RUN);
        while (mc_flash_read(&frame)) {
            if (frame.event) {
                pen(frame.event == 1);
            }
            mc_fpga_write(&frame);
        }
    }
}

int main(void)
{
    return mc_start(run);
}
