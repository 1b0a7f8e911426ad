/* The stop task and the pause task, by the table of states and commands. */
#include "netcard_parts.h"

static void go(struct netcard *c, enum netcard_task task, enum card_turn_step step)
{
    c->step[task] = step;
}

/* STOPPING: bring the player to rest first, then let run and home give up. */
static void stop(struct netcard *c)
{
    go(c, NETCARD_STOP, TURN_WAIT);
    if (c->state != NET_STOPPING) {
        c->dropped++;
        return;
    }
    kernel_mark(&c->kernel, NETCARD_STEP, NETCARD_STOP);
    if (!player_at_rest(&c->player)) {
        player_set_target(&c->player, 0);
        return;
    }
    player_clear(&c->player);
    card_put_rest(c);
    c->home.state = HOME_CYCLE_IDLE;
    if (c->error == NET_DONE) {
        card_rest(c);
    } else {
        c->state = NET_FAULT;
    }
    go(c, NETCARD_STOP, TURN_RELEASE);
}

void card_stop(struct netcard *c)
{
    switch (c->step[NETCARD_STOP]) {
    case TURN_WAIT: card_take(c, NETCARD_STOP, NETCARD_GIVE_STOP, TURN_LOOK); break;
    case TURN_LOOK: card_work(c, NETCARD_STOP, c->settings.step_cycles, TURN_ACT); break;
    case TURN_RELEASE: /* run and home give up */
        go(c, NETCARD_STOP, c->homing != HOMING_NONE ? TURN_RELEASE_HOME : TURN_WAIT);
        kernel_give(&c->kernel, NETCARD_GIVE_FIFO);
        break;
    case TURN_RELEASE_HOME:
        go(c, NETCARD_STOP, TURN_WAIT);
        kernel_give(&c->kernel, NETCARD_GIVE_HOME);
        break;
    default: stop(c);
    }
}

/* Let the motion go on, if it had begun; if not, its own task will let the player go. */
static void resume(struct netcard *c)
{
    kernel_mark(&c->kernel, NETCARD_STEP, NETCARD_PAUSE);
    if (c->state == NET_RUNNING ? card_job_let_go(c) : c->home.state != HOME_CYCLE_IDLE) {
        player_set_target(&c->player, 1);
    }
    go(c, NETCARD_PAUSE, TURN_RELEASE);
}

static void pause(struct netcard *c)
{
    go(c, NETCARD_PAUSE, TURN_WAIT);
    if (c->state == NET_PAUSING) {
        kernel_mark(&c->kernel, NETCARD_STEP, NETCARD_PAUSE);
        player_set_target(&c->player, 0);
        c->state = player_at_rest(&c->player) ? NET_PAUSED : NET_PAUSING;
    } else if (c->state == NET_RUNNING || c->state == NET_HOMING) {
        resume(c);
    } else {
        c->dropped += c->state != NET_PAUSED;
    }
}

void card_pause(struct netcard *c)
{
    switch (c->step[NETCARD_PAUSE]) {
    case TURN_WAIT: card_take(c, NETCARD_PAUSE, NETCARD_GIVE_PAUSE, TURN_LOOK); break;
    case TURN_LOOK: card_work(c, NETCARD_PAUSE, c->settings.step_cycles, TURN_ACT); break;
    case TURN_RELEASE: /* run or home looks at what has become of its motion */
        go(c, NETCARD_PAUSE, TURN_WAIT);
        kernel_give(&c->kernel, c->state == NET_HOMING ? NETCARD_GIVE_HOME : NETCARD_GIVE_FIFO);
        break;
    default: pause(c);
    }
}
