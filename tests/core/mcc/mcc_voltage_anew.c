/* The control law begins anew when the machine has got other axes, and only then. */
#include "mcc_check.h"
#include "voltage.h"

static const struct law none;

/* Follow a machine with the law in the middle of something. Returns whether the law has begun
 * anew. */
static bool anew(struct voltage *v, const struct machine *m)
{
    struct law before;

    memset(&v->law, 1, sizeof v->law);
    before = v->law;
    voltage_follow(v, m);
    const bool begun = memcmp(&v->law, &none, sizeof none) == 0;
    CHECK(begun || memcmp(&v->law, &before, sizeof before) == 0);
    return begun;
}

int main(void)
{
    struct machine m = mcc_machine();
    struct law_config c = { .period = 1e-4 };
    static struct voltage v;

    for (int i = 0; i < 2; i++) {
        c.axis[i].on = m.axis[i].used = true;
        c.axis[i].gain = 1e-3;
    }
    voltage_start(&v, &c, &m);
    CHECK(!anew(&v, &m));
    m.axis[1].inverted = !m.axis[1].inverted;
    CHECK(anew(&v, &m) && !anew(&v, &m));
    m.axis[0].pitch *= 2.0;
    CHECK(anew(&v, &m) && !anew(&v, &m));
    m.axis[0].used = false;
    CHECK(anew(&v, &m) && !v.config.axis[0].on && !anew(&v, &m));
    m.axis[3].inverted = !m.axis[3].inverted; /* no axis of the law */
    CHECK(!anew(&v, &m));
    return check_result();
}
