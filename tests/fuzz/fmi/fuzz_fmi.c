/* Bytes as calls of an FMU in any order, with any values, of both FMI versions side by side; states
 * are saved, made bytes, damaged, restored, also in another instance. Beside ASan and UBSan it
 * holds:
 *   - a call is OK or refused as the state machine of the standards says (struct pair);
 *   - a refused call has one message, or one for each line of a part program that is wrong, and
 *     changes nothing; others have none;
 *   - both versions answer alike, have the same state and take each other's;
 *   - files are only made in the scratch folder, and what was there beside regular files stays.
 * The bytes of a state, damaged or not, are a file, too, in which an instance may begin. */
#include <math.h>

#include "holds.h"
#include "pair.h"
#include "scratch.h"
#include "values.h"

enum { CALLS = 100, PAIRS = 2, SLOTS = 3 };

/* Simulated time of an input [ns]: less with another parameter, as it may be a period or a time
 * constant on which the number of instants depends, and much less with one of another order. */
static const int64_t BUDGET = 60000000, BUDGET_OTHER = 5000000, BUDGET_ORDER = 10000;

static struct pair pairs[PAIRS];
static struct slot slots[SLOTS];
static char *bytes[VERSIONS], *other; /* serialized states */
static bool in_bytes;                 /* there is one in bytes[] */
static enum stand bytes_stand;
static double bytes_point;
static int64_t budget; /* [ns] left */
static bool wrote;

static void shorten(const struct inside_variable *v, union side_value x, union side_value start)
{
    const double part = fabs(x.real / start.real); /* NaN: both are 0 */
    if (v->type == SIDE_REAL && !v->running && x.real != start.real) {
        const int64_t most = part >= 0.2 && part <= 5.0 ? BUDGET_OTHER : BUDGET_ORDER;
        budget = budget < most ? budget : most;
    }
}

static size_t pick_variable(struct bytes *b)
{
    const uint32_t n = take(b, 2);
    if (n < 0xe000) {
        return n % inside_count();
    }
    for (size_t i = 0, k = n & 7; i < 8 * inside_count(); i++) { /* a string, if there is one */
        if (inside_variable(i % inside_count()).type == SIDE_STRING && k-- == 0) {
            return i % inside_count();
        }
    }
    return 0;
}

static void set(struct pair *p, struct bytes *b)
{
    static union side_value x[SIDE_ELEMENTS];
    const size_t i = pick_variable(b);
    const struct inside_variable v = inside_variable(i);
    const bool all = take(b, 1) & 1;
    bool good =
        v.settable
        && (p->stand == NEW || p->stand == INITIALIZING || (p->stand == RUNNING && v.running));
    HOLDS(v.count <= SIDE_ELEMENTS);
    const bool allowed = good;
    for (size_t k = 0; k < v.count; k++) {
        x[k] = k == 0 || !all ? value(b, &v, inside_start(i, k)) : x[0];
        good = good && legal(&v, x[k]);
    }
    for (size_t k = 0; k < v.count && good && allowed; k++) {
        shorten(&v, x[k], inside_start(i, k));
    }
    if (good) {
        HOLDS(BOTH(set(p->c[v_], v.type, v.ref, v.count, x)) == 0);
    } else {
        REFUSED(p, set(p->c[v_], v.type, v.ref, v.count, x));
    }
}

static void get(struct pair *p, struct bytes *b)
{
    static union side_value x[VERSIONS][SIDE_ELEMENTS];
    const struct inside_variable v = inside_variable(pick_variable(b));
    if (!v.settable && p->stand == NEW) {
        REFUSED(p, get(p->c[v_], v.type, v.ref, v.count, x[v_]));
        return;
    }
    const int status = BOTH(get(p->c[v_], v.type, v.ref, v.count, x[v_]));
    HOLDS(status == 0 || (!v.settable && p->stand == INITIALIZING)); /* a start may fail */
    for (size_t k = 0; k < v.count && status == 0; k++) {
        HOLDS(equal(v.type, x[0][k], x[1][k]));
        HOLDS(v.type != SIDE_REAL || isfinite(x[0][k].real));
    }
}

static void enter(struct pair *p, struct bytes *b)
{
    static const double starts[] = { 0.0, 0.0, 0.0, 1.0, -5.0, 1e6, NAN, INFINITY };
    static const double spans[] = { 1.0, 1e-3, 0.0, 2e-3, -1e-3, NAN, INFINITY, 1.0 };
    const uint32_t n = take(b, 1);
    const double start = starts[n & 7], stop = start + spans[n >> 3 & 7];
    const bool stops = n >> 6 & 1, hasty = n >> 7 && (p->stand != NEW || isnan(p->point));
    if (p->stand == NEW && isfinite(start) && (!stops || stop >= start)) {
        HOLDS(BOTH(enter(p->c[v_], start, stops, stop, hasty)) == 0);
        p->stand = INITIALIZING;
        p->point = start;
        p->stop = stops ? stop : INFINITY;
    } else {
        REFUSED(p, enter(p->c[v_], start, stops, stop, hasty));
    }
}

static void leave(struct pair *p)
{
    if (p->stand != INITIALIZING) {
        REFUSED(p, leave(p->c[v_]));
    } else if (BOTH(leave(p->c[v_])) == 0) {
        p->stand = RUNNING;
    }
}

static void step(struct pair *p, struct bytes *b)
{
    static const double wrong[] = { 0.0, -1e-3, NAN, INFINITY, 1e300, 1e-11, -INFINITY, 1e-320 };
    const uint32_t n = take(b, 1), kind = n & 7;
    const double tick = inside_tick() * 1e-9;
    const int64_t ns = kind == 0  ? (int64_t)inside_tick() * (1 + (n >> 3))
                       : kind < 4 ? INT64_C(100000) * (1 + (n >> 3))
                                  : 1000000 * (1 + (n >> 5));
    double t = p->point, h = (double)ns * 1e-9;
    bool good = p->stand == RUNNING;
    if (kind == 6) {
        h = (n & 8) ? wrong[n >> 4 & 7] : h + 0.3 * tick;
        good = good && h > 0.0 && h < 1.0 && !inside_strict(p->c[1]);
    } else if (kind == 7) {
        t = (n & 8) ? wrong[n >> 4 & 7] + t + 1.0 : t + 1e-3;
        good = false;
    }
    if (t + h > p->stop + 0.5 * tick) {
        good = false;
    }
    if (!good) {
        REFUSED(p, step(p->c[v_], t, h));
        return;
    }
    if (budget < ns) {
        return;
    }
    budget -= ns;
    if (BOTH(step(p->c[v_], t, h)) == 0) {
        p->point = t + h;
    } else {
        p->stand = FAILED;
    }
}

static void terminate(struct pair *p)
{
    if (p->stand != RUNNING) {
        REFUSED(p, terminate(p->c[v_]));
        return;
    }
    (void)BOTH(terminate(p->c[v_])); /* a file may not be written */
    p->stand = ENDED;
    wrote = true;
}

static void reset(struct pair *p)
{
    HOLDS(BOTH(reset(p->c[v_])) == 0);
    p->stand = NEW;
    p->point = NAN;
    p->stop = INFINITY;
}

static void restore(struct pair *p, const struct slot *s)
{
    if (!s->state[0]) {
        return;
    }
    pair_look(p);
    if (BOTH(set_state(p->c[v_], s->state[v_])) == 0) {
        p->stand = s->stand;
        p->point = s->point;
    } else {
        pair_same(p); /* its files cannot be opened any more */
    }
}

static void keep(struct pair *p, struct slot *s)
{
    if (p->stand == FAILED) {
        const void *was = s->state[0];
        HOLDS(BOTH(get_state(p->c[v_], &s->state[v_])) == ERROR && s->state[0] == was);
        return;
    }
    pair_save(p, s);
}

static void to_bytes(struct pair *p, struct slot *s)
{
    if (s->state[0]) {
        pair_write(p, s, bytes);
        in_bytes = wrote = true;
        scratch_state(bytes[0], inside_size(bytes[0]));
        bytes_stand = s->stand;
        bytes_point = s->point;
    }
}

static void from_bytes(struct pair *p, struct slot *s)
{
    if (in_bytes) {
        HOLDS(BOTH(deserialize(p->c[v_], bytes[1 - v_], inside_size(bytes[1 - v_]), &s->state[v_]))
              == 0);
        s->stand = bytes_stand;
        s->point = bytes_point;
    }
}

/* Bytes that nobody handed out are no state. */
static void from_damaged(struct pair *p, struct bytes *b)
{
    void *state[VERSIONS] = { NULL, NULL };
    if (!in_bytes) {
        return;
    }
    const size_t size = inside_size(bytes[0]);
    memcpy(other, bytes[0], size);
    for (uint32_t n = 1 + take(b, 1) % 4; n > 0; n--) {
        const uint32_t at = take(b, 3);
        other[at % size] = (char)(other[at % size] + 1 + (int)take(b, 1) % 255);
    }
    if (memcmp(other, bytes[0], size) != 0) {
        REFUSED(p, deserialize(p->c[v_], other, size, &state[v_]));
        const size_t less = size - 1 - take(b, 1) % 64;
        REFUSED(p, deserialize(p->c[v_], bytes[0], less, &state[v_]));
        HOLDS(!state[0] && !state[1]);
        scratch_state(other, size);
    }
}

static void release(struct pair *p)
{
    pair_settle();
    for (int v = 0; v < VERSIONS; v++) {
        side[v]->release(p->c[v]);
        p->c[v] = NULL;
    }
}

static void renew(struct pair *p)
{
    release(p);
    for (int v = 0; v < VERSIONS; v++) {
        p->c[v] = side[v]->instantiate(inside_token(), "file:///tmp/none");
        HOLDS(p->c[v]);
    }
    p->stand = NEW;
    p->point = NAN;
    p->stop = INFINITY;
}

static void renew_wrongly(void)
{
    for (int v = 0; v < VERSIONS; v++) {
        side_told[v].errors = 0;
        HOLDS(!side[v]->instantiate("{another}", "") && side_told[v].errors == 1);
    }
}

static void log_switch(struct pair *p, struct bytes *b)
{
    static const char *const names[] = { "logEvents", "logStatusWarning", "logStatusError", "all" };
    const uint32_t n = take(b, 1);
    if (n % 4 == 3) {
        REFUSED(p, log(p->c[v_], n & 16, 1, names + 3));
    } else {
        HOLDS(BOTH(log(p->c[v_], n & 16, 1 + n % 3 - (n % 4 == 0), names)) == 0);
    }
}

static void call(struct bytes *b)
{
    const uint32_t n = take(b, 1);
    struct pair *p = &pairs[n >> 7 & 1];
    struct slot *s = &slots[(n >> 5 & 3) % SLOTS];
    if (!p->c[0]) { /* few inputs come to the second pair, and large models take long to make */
        renew(p);
    }
    switch (n & 31) {
    case 0:  enter(p, b); break;
    case 1:  leave(p); break;
    case 2:
    case 3:
    case 4:
    case 5:
    case 6:  step(p, b); break;
    case 7:
    case 8:
    case 9:
    case 10:
    case 11:
    case 12: set(p, b); break;
    case 13:
    case 14:
    case 15:
    case 16: get(p, b); break;
    case 17: terminate(p); break;
    case 18: reset(p); break;
    case 19:
    case 20: keep(p, s); break;
    case 21:
    case 22: restore(p, s); break;
    case 23: to_bytes(p, s); break;
    case 24: from_bytes(p, s); break;
    case 25:
    case 26: from_damaged(p, b); break;
    case 27: HOLDS(BOTH(free_state(p->c[v_], &s->state[v_])) == 0 && !s->state[0]); break;
    case 28: {
        const uint32_t which = take(b, 1);
        REFUSED(p, odd(p->c[v_], which));
        break;
    }
    case 29: log_switch(p, b); break;
    case 30:
        renew_wrongly();
        renew(p);
        break;
    default: /* in order, as most importers go */
        if (p->stand == NEW) {
            enter(p, &(struct bytes){ NULL, NULL });
        }
        leave(p);
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t length)
{
    struct bytes b = { data, data + length };
    if (!other || wrote) {
        scratch_open();
    }
    wrote = in_bytes = false;
    budget = BUDGET;
    renew(&pairs[0]);
    if (!other) {
        bytes[0] = malloc(inside_most()), bytes[1] = malloc(inside_most());
        other = malloc(inside_most());
        HOLDS(bytes[0] && bytes[1] && other);
    }
    for (int i = 0; i < CALLS && b.at < b.end; i++) {
        call(&b);
    }
    for (int i = 0; i < PAIRS; i++) {
        for (int k = 0; k < SLOTS && i == 0; k++) {
            HOLDS(BOTH(free_state(pairs[0].c[v_], &slots[k].state[v_])) == 0);
        }
        if (pairs[i].c[0] && pairs[i].stand != FAILED) { /* both versions at the same place */
            pair_save(&pairs[i], &slots[0]);
            pair_write(&pairs[i], &slots[0], bytes);
            HOLDS(BOTH(free_state(pairs[0].c[v_], &slots[0].state[v_])) == 0);
        }
    }
    release(&pairs[0]);
    release(&pairs[1]);
    scratch_check();
    return 0;
}
