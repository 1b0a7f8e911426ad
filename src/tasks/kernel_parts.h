/* kernel_parts - what kernel.c and kernel_calls.c share. */
#ifndef KERNEL_PARTS_H
#define KERNEL_PARTS_H

#include "kernel.h"

enum { KERNEL_PRIORITY_MAX = 1000 };

void kernel_note(struct kernel *k, enum kernel_what what, int32_t number, int32_t value);

/* The kernel chooses anew as soon as no interrupt is served; then tasks that interrupts have woken
 * can be seen. */
void kernel_choose(struct kernel *k);

/* A task is ready, at the end of its equals; hidden: from the next time on that the kernel
 * chooses. */
void kernel_wake(struct kernel *k, int task, bool hidden);

#endif
