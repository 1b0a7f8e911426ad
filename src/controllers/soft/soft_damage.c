#include "soft.h"

const char *soft_damage(const struct soft *s, int64_t clock)
{
    if (robot_damaged(&s->robot)) {
        return "its arm";
    }
    if (layers_damaged(&s->layers, clock) || outbox_damaged(&s->outbox)) {
        return "its layers";
    }
    if (s->heads < 0 || s->heads >= SOFT_QUEUE || s->count < 0 || s->count > SOFT_QUEUE ||
        s->output_count < 0 || s->output_count > SOFT_OUTPUTS) {
        return "its queues";
    }
    for (int i = 0; i < s->output_count; i++) {
        if (s->output[i].index < 0 || s->output[i].index >= FPGA_ANALOG) {
            return "its outputs";
        }
    }
    if (s->memory < 0 || s->memory > 1 || s->given < 0 || s->taught_count < 0 ||
        s->taught_count > SOFT_TAUGHT || s->replaying < -1 || s->replaying > s->taught_count) {
        return "its counts";
    }
    return NULL;
}
