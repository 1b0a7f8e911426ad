/* Links at random: split, late, cut, with bytes that change on the way; and a card that loses its
 * power. */
#include "link_rig.h"

enum { ROUNDS = 300, CUTS = 6, MOST_MS = 400000 };

static void arm(struct rig *r)
{
    struct rig_stream *s = check_random(&r->seed, 0, 1) ? &r->to_card : &r->to_host;
    if (r->to_card.cut_after < 0 && r->to_host.cut_after < 0 && r->cuts < CUTS)
        s->cut_after = s->passed + check_random(&r->seed, 0, s == &r->to_card ? 9000 : 3000);
}

static void change_a_byte(struct rig_stream *s, uint64_t *seed)
{
    if (s->count > 0) {
        const int at = (s->first + (int)check_random(seed, 0, s->count - 1)) % RIG_STREAM;
        s->byte[at] ^= (uint8_t)(1 << check_random(seed, 0, 7));
    }
}

static void start(struct rig *r, int round, bool keyed)
{
    rig_start(r, (uint32_t)(1 + round % RIG_PAGES), keyed, 1000 + (uint64_t)round);
    r->delay_most = check_random(&r->seed, 0, 30) * RIG_MS;
    r->piece_most = (int)check_random(&r->seed, 20, 1500);
}

/* Whatever the link does, the job is whole and each command is done once. */
static void check_links(struct rig *r)
{
    int cuts = 0;
    for (int round = 0; round < ROUNDS; round += CHECK_EACH) {
        start(r, round, round & 1);
        const int orders = rig_orders(r);
        for (int64_t i = 0; i < MOST_MS && !rig_is_done(r); i++) {
            arm(r);
            rig_step(r);
            if (check_random(&r->seed, 0, 399) == 0 && r->connected && r->cuts < CUTS) {
                change_a_byte(check_random(&r->seed, 0, 1) ? &r->to_card : &r->to_host, &r->seed);
            }
        }
        CHECK(rig_is_done(r));
        rig_check(r, orders);
        cuts += (int)r->host.connections - 1;
        if (check_failures > 0) {
            printf("round %d\n", round);
            return;
        }
    }
    printf("%d links: %d connections lost\n", ROUNDS / CHECK_EACH, cuts);
    CHECK(cuts > ROUNDS / CHECK_EACH);
}

/* Without power the card forgets its numbers: a command is done once or not at all, and told so. */
static void check_power(struct rig *r)
{
    int lost = 0, answered = 0;
    for (int round = 0; round < ROUNDS; round += CHECK_EACH) {
        start(r, round, true);
        const int orders = rig_orders(r);
        const int64_t off = check_random(&r->seed, 1, 80) * RIG_MS;
        for (int64_t i = 0; i < MOST_MS && !rig_is_done(r); i++) {
            rig_step(r);
            if (r->now == off) {
                session_power_up(&r->card.session, r->now);
                r->card.late = 0;
                net_host_cut(&r->host);
                r->connected = false;
                r->to_card.count = r->to_host.count = 0;
            }
        }
        CHECK(rig_is_done(r));
        for (int i = 0; i < orders; i++) {
            const struct net_host_order *o = &r->host.order[i];
            const int done = r->card.done[o->number % RIG_NUMBERS];
            CHECK(o->stage == NET_HOST_ANSWERED ? done == 1 : done <= 1);
            lost += o->stage == NET_HOST_LOST;
            answered += o->stage == NET_HOST_ANSWERED;
        }
        if (check_failures > 0) {
            printf("power, round %d\n", round);
            return;
        }
    }
    printf("power lost: %d commands answered, %d lost\n", answered, lost);
    CHECK(lost > 0 && answered > lost);
}

/* Behind the link is another card, or the same one: which of them gets the commands that were on
 * their way? Only the same one, with the number it knows. */
static void check_other_card(struct rig *r)
{
    for (int other = 0; other < 2; other++) {
        rig_start(r, 4, false, 77);
        const uint16_t life = r->card.session.life;
        CHECK(rig_run(r, MOST_MS));
        const struct net_host_order start_order = { .at = r->now, .type = NET_START, .axes = 3 };
        CHECK(net_host_give(&r->host, &start_order));
        const int64_t lost = r->to_card.passed + 1;
        r->to_card.cut_after = lost; /* in the midst of the command */
        for (int i = 0; i < 1000 && r->cuts == 0; i++) {
            rig_step(r);
        }
        CHECK_EQ(r->cuts, 1);
        const struct net_host_order *o = &r->host.order[0];
        CHECK_EQ(o->stage, NET_HOST_SENT);
        r->card.session.config.card += other;
        CHECK_EQ(r->card.session.life, life); /* what else a card is known by */
        for (int i = 0; i < 3000; i++) {
            rig_step(r);
        }
        CHECK_EQ(r->host.connections, 2);
        CHECK_EQ(o->stage, other ? NET_HOST_LOST : NET_HOST_ANSWERED);
        CHECK_EQ(r->card.done[o->number % RIG_NUMBERS], !other);
    }
}

int main(void)
{
    static struct rig r;
    check_links(&r);
    check_power(&r);
    check_other_card(&r);
    return check_result();
}
