/* ADC: codes, comparator, group; all of it against a model that does one clock at a time. */
#include "adc.h"
#include "check.h"
#include "irq.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

_Static_assert((int)ADC_EVENT_COMPARE == (int)IRQ_ADC_COMP
                   && (int)ADC_EVENT_DONE == (int)IRQ_ADC_CONV
                   && (int)ADC_EVENT_TAG == (int)IRQ_ADC_TAG,
               "events are bits of the latch");

enum { DONE = 1 << ADC_EVENT_DONE, TAG = 1 << ADC_EVENT_TAG };

static const double ZERO[ADC_CHANNELS];

/* Every code goes to its voltage and back; so does all that is nearer to it than to its neighbours,
 * and the middle between two codes goes away from zero. */
static void codes(void)
{
    for (int k = 0; k < 6; k++) {
        struct adc_config c = { 12 + 2 * (k / 2), 1 };
        enum adc_range range = k % 2 == 0 ? ADC_BIPOLAR : ADC_UNIPOLAR;
        double lsb = (k % 2 == 0 ? 20.0 : 10.0) / (1 << c.bits);
        int32_t low = k % 2 == 0 ? -(1 << (c.bits - 1)) : 0, high = low + (1 << c.bits) - 1;
        int32_t wrong = 0;
        for (int32_t code = low; code <= high; code++) {
            double volts = adc_volts(&c, range, code);
            int32_t up = code == high ? high : code + 1, down = code == low ? low : code - 1;
            wrong += volts != code * lsb;
            wrong += adc_code(&c, range, volts) != code;
            wrong += adc_code(&c, range, volts + 0.499 * lsb) != code;
            wrong += adc_code(&c, range, volts - 0.499 * lsb) != code;
            wrong += adc_code(&c, range, volts + 0.5 * lsb) != (code >= 0 ? up : code);
            wrong += adc_code(&c, range, volts - 0.5 * lsb) != (code <= 0 ? down : code);
        }
        CHECK_EQ(wrong, 0);
        for (int i = 0; i < 3; i++) {
            double beyond = (double[]){ 10.0, 1e308, INFINITY }[i];
            CHECK_EQ(adc_code(&c, range, beyond), high);
            CHECK_EQ(adc_code(&c, range, -beyond), low);
        }
        CHECK_EQ(adc_code(&c, range, nextafter(lsb / 2, 0.0)), 0);
        CHECK_EQ(adc_code(&c, range, NAN), 0);
    }
    struct adc_config c = { 12, 1 };
    CHECK_EQ(adc_code(&c, ADC_BIPOLAR, -5.0), -1024);
    CHECK_EQ(adc_code(&c, ADC_UNIPOLAR, 5.0), 2048);
}

/* One member of a good control becomes `value`: the answer, and the control left as it is. */
#define REFUSED(member, value, want) \
    do { \
        struct adc_control changed, before; \
        memcpy(&changed, &good, sizeof good); \
        changed.member = value; \
        memcpy(&before, &changed, sizeof before); \
        CHECK_EQ(adc_check_control(&changed), want); \
        CHECK(memcmp(&before, &changed, sizeof before) == 0); \
    } while (0)

static void settings(void)
{
    for (int32_t bits = -1; bits <= 40; bits++) {
        bool good = bits == 12 || bits == 14 || bits == 16;
        CHECK_EQ(adc_check_config(&(struct adc_config){ bits, 1 }), good ? ADC_OK : ADC_BAD_BITS);
    }
    CHECK_EQ(adc_check_config(&(struct adc_config){ 12, 0 }), ADC_BAD_TIME);
    CHECK_EQ(adc_check_config(&(struct adc_config){ 12, INT32_MIN }), ADC_BAD_TIME);
    struct adc_control good = { .range = { [7] = ADC_UNIPOLAR } };
    REFUSED(mode, ADC_FREE_RUN, ADC_OK);
    REFUSED(mode, (enum adc_mode)2, ADC_BAD_MODE);
    REFUSED(mode, (enum adc_mode) - 1, ADC_BAD_MODE);
    REFUSED(channel, 7, ADC_OK);
    REFUSED(channel, 8, ADC_BAD_CHANNEL);
    REFUSED(channel, -1, ADC_BAD_CHANNEL);
    REFUSED(enabled, 0xFF, ADC_OK);
    REFUSED(enabled, 0x100, ADC_BAD_MASK);
    REFUSED(compare_on, 0xFF, ADC_OK);
    REFUSED(compare_on, 0x80000000, ADC_BAD_MASK);
    REFUSED(tagged, 0xFF, ADC_OK);
    REFUSED(tagged, 0x100, ADC_BAD_MASK);
    REFUSED(ignored_bits, 3, ADC_OK);
    REFUSED(ignored_bits, 4, ADC_BAD_IGNORED);
    REFUSED(ignored_bits, -1, ADC_BAD_IGNORED);
    for (int i = 0; i < ADC_CHANNELS; i++) {
        REFUSED(range[i], (enum adc_range)2, ADC_BAD_RANGE);
        REFUSED(compare[i], ADC_BOTH, ADC_OK);
        REFUSED(compare[i], (enum adc_compare)3, ADC_BAD_COMPARE);
        REFUSED(compare_volts[i], 10.0, ADC_OK);
        REFUSED(compare_volts[i], nextafter(10.0, 11.0), ADC_BAD_VOLTS);
        REFUSED(compare_volts[i], -10.0, i == 7 ? ADC_BAD_VOLTS : ADC_OK);
        REFUSED(compare_volts[i], nextafter(-10.0, -11.0), ADC_BAD_VOLTS);
        REFUSED(compare_volts[i], -1e-300, i == 7 ? ADC_BAD_VOLTS : ADC_OK);
        REFUSED(compare_volts[i], NAN, ADC_BAD_VOLTS);
        REFUSED(compare_volts[i], -INFINITY, ADC_BAD_VOLTS);
    }
}

/* Single mode to the clock: sampled at the start, coded at the end; restart and stop drop. */
static void single(void)
{
    struct adc_config c = { 12, 400 };
    struct adc_control set = { .mode = ADC_SINGLE, .channel = 3, .enabled = 0xFF };
    struct adc a = { 0 };
    double volts[ADC_CHANNELS] = { [3] = 5.0 };
    CHECK_EQ(adc_due(&a), INT64_MAX);
    adc_start(&c, &set, &a, volts, 1000);
    CHECK_EQ(adc_due(&a), 1400);
    volts[3] = 2.5; /* after the sample: not seen */
    CHECK_EQ(adc_finish(&c, &set, &a, volts), DONE);
    CHECK_EQ(a.code[3], 1024);
    CHECK_EQ(adc_due(&a), INT64_MAX);
    struct adc before;
    memcpy(&before, &a, sizeof a);
    CHECK_EQ(adc_finish(&c, &set, &a, volts), 0);
    CHECK(memcmp(&before, &a, sizeof a) == 0);
    adc_start(&c, &set, &a, volts, 2000);
    set.channel = 4; /* holds from the next start on */
    CHECK_EQ(adc_finish(&c, &set, &a, volts), DONE);
    CHECK_EQ(a.code[3], 512);
    set.channel = 3;
    adc_start(&c, &set, &a, volts, 3000);
    volts[3] = -5.0;
    adc_start(&c, &set, &a, volts, 3399); /* one clock before the end */
    CHECK_EQ(adc_due(&a), 3799);
    CHECK_EQ(a.conversions, 2);
    CHECK_EQ(adc_finish(&c, &set, &a, volts), DONE);
    CHECK_EQ(a.code[3], -1024);
    adc_start(&c, &set, &a, ZERO, 4000);
    adc_stop(&a);
    CHECK_EQ(adc_due(&a), INT64_MAX);
    CHECK_EQ(a.code[3], -1024);
    a.conversions = INT32_MAX;
    adc_start(&c, &set, &a, ZERO, 5000);
    adc_finish(&c, &set, &a, ZERO);
    CHECK_EQ(a.conversions, 0);
}

/* Free run: order, clocks, the instant of each sample, an emptied mask. */
static void free_run(void)
{
    static const int order[] = { 0, 2, 5, 7, 0, 2, 5, 7, 0 };
    struct adc_config c = { 16, 100 };
    struct adc_control set = { .mode = ADC_FREE_RUN, .channel = 1, .enabled = 0xA5 };
    struct adc a = { 0 };
    double volts[ADC_CHANNELS];
    for (int n = 0; n <= 8; n++) {
        for (int i = 0; i < ADC_CHANNELS; i++)
            volts[i] = adc_volts(&c, ADC_BIPOLAR, 1000 * n + i);
        if (n == 0)
            adc_start(&c, &set, &a, volts, 50);
        else
            CHECK_EQ(adc_finish(&c, &set, &a, volts), DONE);
        CHECK_EQ(adc_due(&a), 50 + 100 * (n + 1));
        CHECK_EQ(a.channel, order[n]);
        if (n > 0)
            CHECK_EQ(a.code[order[n - 1]], 1000 * (n - 1) + order[n - 1]);
    }
    set.enabled = 0x02; /* channel 0 is under way: it ends, then 1 */
    CHECK_EQ(adc_finish(&c, &set, &a, volts), DONE);
    CHECK_EQ(a.channel, 1);
    set.enabled = 0;
    CHECK_EQ(adc_finish(&c, &set, &a, volts), DONE);
    CHECK_EQ(a.code[1], 8001);
    CHECK(!a.busy);
    set.enabled = 0x80; /* does not go on by itself */
    CHECK_EQ(adc_due(&a), INT64_MAX);
    adc_start(&c, &set, &a, volts, 7000);
    CHECK_EQ(a.channel, 7);
    set.enabled = 0;
    adc_start(&c, &set, &a, volts, 7050); /* drops channel 7, converts nothing */
    CHECK_EQ(adc_due(&a), INT64_MAX);
    CHECK_EQ(a.conversions, 10);
}

static void changed_mode(void)
{
    struct adc_config c = { 16, 100 };
    struct adc_control set = { .mode = ADC_SINGLE, .channel = 1 };
    struct adc a = { 0 };
    adc_start(&c, &set, &a, ZERO, 8000);
    set.mode = ADC_FREE_RUN;
    set.enabled = 0x03; /* goes on behind the single one, wrapping */
    CHECK_EQ(adc_finish(&c, &set, &a, ZERO), DONE);
    CHECK_EQ(a.channel, 0);
    set.mode = ADC_SINGLE;
    CHECK_EQ(adc_finish(&c, &set, &a, ZERO), DONE);
    CHECK(!a.busy);
}

/* One single conversion of channel 2 of a voltage given as a 12-bit code: did it fire? */
static bool fires(const struct adc_control *set, struct adc *a, int32_t code)
{
    struct adc_config c = { 12, 1 };
    double volts[ADC_CHANNELS] = { [2] = adc_volts(&c, set->range[2], code) };
    adc_start(&c, set, a, volts, 0);
    uint32_t events = adc_finish(&c, set, a, ZERO);
    CHECK_EQ(events & ~4u, DONE);
    return (events & 4) != 0;
}

/* Preset 100: what each step of the value fires, with 0 and with 2 bits ignored. */
static void comparator(void)
{
    static const struct {
        int32_t from, to;
        bool rising, falling, rising2, falling2;
    } step[] = {
        { 99, 100, true, false, true, false },     { 99, 101, true, false, true, false },
        { 100, 101, false, false, false, false },  { 100, 100, false, false, false, false },
        { 98, 99, false, false, false, false },    { 101, 100, false, true, false, false },
        { 101, 99, false, true, false, false },    { 100, 99, false, false, false, false },
        { 104, 103, false, false, false, true },   { 104, 99, false, true, false, true },
        { -2048, 2047, true, false, true, false }, { 2047, -2048, false, true, false, true },
    };
    struct adc_config c = { 12, 1 };
    for (int sign = 1; sign >= -1; sign -= 2)
        for (int n = 0; n < 12 - 2 * (sign < 0); n++)
            for (int way = ADC_RISING; way <= ADC_BOTH; way++)
                for (int ignored = 0; ignored <= 2; ignored += 2) {
                    int32_t shift = sign < 0 ? -400 : 0; /* the same around -300 */
                    int32_t preset = 100 + shift + (ignored == 2 ? n % 4 : 0);
                    bool up = ignored == 0 ? step[n].rising : step[n].rising2;
                    bool down = ignored == 0 ? step[n].falling : step[n].falling2;
                    struct adc_control set = { .channel = 2,
                                               .compare_on = 4,
                                               .compare = { [2] = (enum adc_compare)way },
                                               .ignored_bits = ignored,
                                               .compare_volts = {
                                                   [2] = adc_volts(&c, ADC_BIPOLAR, preset) } };
                    struct adc a = { 0 };
                    CHECK(!fires(&set, &a, step[n].from + shift)); /* no predecessor */
                    CHECK_EQ(fires(&set, &a, step[n].to + shift),
                             (up && way != ADC_FALLING) || (down && way != ADC_RISING));
                    set.compare_on = 0xFB;
                    CHECK(!fires(&set, &a, step[n].from + shift));
                    CHECK(!fires(&set, &a, step[n].to + shift));
                }
}

/* What has no predecessor, and what a changed preset or range does. */
static void predecessors(void)
{
    struct adc_config c = { 12, 1 };
    struct adc_control set = { .channel = 2, .enabled = 4, .compare_on = 4 };
    struct adc a = { 0 };
    set.compare[2] = ADC_BOTH;
    set.compare_volts[2] = adc_volts(&c, ADC_BIPOLAR, 100);
    CHECK(!fires(&set, &a, 200)); /* first since power on: at the preset already */
    set.compare_volts[2] = adc_volts(&c, ADC_BIPOLAR, 300);
    CHECK(!fires(&set, &a, 200)); /* the preset jumped over the value: nothing */
    CHECK(fires(&set, &a, 300));
    set.compare_on = 0;
    CHECK(!fires(&set, &a, 0));
    set.compare_on = 4; /* a value not compared is a predecessor too */
    CHECK(fires(&set, &a, 300));
    set.range[2] = ADC_UNIPOLAR; /* 300 now is half the voltage */
    set.compare_volts[2] = adc_volts(&c, ADC_UNIPOLAR, 400);
    CHECK(!fires(&set, &a, 500));
    CHECK(fires(&set, &a, 399));
    adc_start(&c, &set, &a, ZERO, 0);
    adc_stop(&a); /* neither the dropped one nor the stop counts */
    CHECK(fires(&set, &a, 4095));
    set.mode = ADC_FREE_RUN; /* each start of free run begins anew */
    for (int n = 0; n < 3; n++)
        CHECK(!fires(&set, &a, n % 2 == 0 ? 4095 : 0));
    set.mode = ADC_SINGLE;
    CHECK(fires(&set, &a, 0));
    double volts[ADC_CHANNELS] = { [2] = 5.0 }; /* the range is that of the end */
    adc_start(&c, &set, &a, volts, 0);
    set.range[2] = ADC_BIPOLAR;
    adc_finish(&c, &set, &a, volts);
    CHECK_EQ(a.code[2], 1024);
    CHECK_EQ(a.range[2], ADC_BIPOLAR);
}

/* Free run over `enabled`: the group must fire at exactly these of the next 12 conversions. */
static void fires_at(const struct adc_control *set, struct adc *a, uint32_t want)
{
    struct adc_config c = { 12, 1 };
    uint32_t got = 0;
    for (int n = 0; n < 12; n++)
        got |= (adc_finish(&c, set, a, ZERO) == (DONE | TAG) ? 1u : 0u) << n;
    CHECK_EQ(got, want);
}

static void group(void)
{
    struct adc_config c = { 12, 1 };
    struct adc_control set = { .mode = ADC_FREE_RUN, .enabled = 0x0F, .tagged = 0x05 };
    struct adc a = { 0 };
    adc_start(&c, &set, &a, ZERO, 0);
    fires_at(&set, &a, 0x444); /* at each end of channel 2 */
    set.tagged = 0;
    fires_at(&set, &a, 0);
    set.tagged = 0x11; /* channel 4 is not enabled */
    fires_at(&set, &a, 0);
    adc_finish(&c, &set, &a, ZERO);
    set.tagged = 0x06; /* 0 does not count any more: 1, 2 */
    fires_at(&set, &a, 0x222);
    set.tagged = 0x05; /* stands before 1: 2, then 0 */
    fires_at(&set, &a, 0x888);
    adc_finish(&c, &set, &a, ZERO);
    adc_finish(&c, &set, &a, ZERO);     /* 1, 2 */
    adc_start(&c, &set, &a, ZERO, 100); /* afresh: 0, 1, 2 */
    fires_at(&set, &a, 0x444);
    set.mode = ADC_SINGLE; /* single conversions fill a group too */
    for (int n = 0; n < 8; n++) {
        set.channel = n % 2 == 0 ? 0 : 2;
        adc_start(&c, &set, &a, ZERO, 200);
        CHECK_EQ(adc_finish(&c, &set, &a, ZERO), n % 2 == 0 ? DONE : DONE | TAG);
    }
}

/* The model: it counts clocks, works in whole units of 10 V / 2^17 (half a step of the finest
 * range) and writes out what the header promises in the plainest way. */
struct model {
    int32_t code[ADC_CHANNELS], before[ADC_CHANNELS];
    int range_before[ADC_CHANNELS];
    bool has_before[ADC_CHANNELS], got[ADC_CHANNELS];
    int channel;
    int64_t held, left; /* [units], [clocks] still to go */
    int32_t conversions;
    bool busy;
};

static int32_t model_code(int bits, int range, int64_t units)
{
    int64_t step = (range == ADC_BIPOLAR ? 2 : 1) * ((int64_t)1 << (17 - bits));
    int64_t low = range == ADC_BIPOLAR ? -(1 << (bits - 1)) : 0, high = low + (1 << bits) - 1;
    int64_t code = (llabs(units) + step / 2) / step * (units < 0 ? -1 : 1);
    return (int32_t)(code < low ? low : code > high ? high : code);
}

static void model_sample(struct model *m, int time, const int64_t units[ADC_CHANNELS])
{
    m->busy = true;
    m->left = time;
    m->held = units[m->channel];
}

static void model_start(const struct adc_config *c, const struct adc_control *set, struct model *m,
                        const int64_t units[ADC_CHANNELS])
{
    m->busy = false;
    if (set->mode == ADC_SINGLE) {
        m->channel = set->channel;
        model_sample(m, c->time, units);
        return;
    }
    for (int i = 0; i < ADC_CHANNELS; i++)
        m->has_before[i] = m->got[i] = false;
    for (int i = ADC_CHANNELS - 1; i >= 0; i--)
        if (set->enabled & 1u << i) {
            m->channel = i;
            model_sample(m, c->time, units);
        }
}

static bool model_compare(const struct adc_config *c, const struct adc_control *set,
                          struct model *m, int64_t preset)
{
    int i = m->channel;
    double unit = (double[]){ 1, 2, 4, 8 }[set->ignored_bits];
    double at = floor(model_code(c->bits, set->range[i], preset) / unit);
    double old = floor(m->before[i] / unit), now = floor(m->code[i] / unit);
    bool comparable = m->has_before[i] && m->range_before[i] == (int)set->range[i];
    m->has_before[i] = true;
    m->range_before[i] = set->range[i];
    m->before[i] = m->code[i];
    if (!comparable || !(set->compare_on >> i & 1))
        return false;
    bool up = old < at && at <= now, down = old > at && at >= now;
    return set->compare[i] == ADC_RISING ? up : set->compare[i] == ADC_FALLING ? down : up || down;
}

/* One clock passes. */
static uint32_t model_tick(const struct adc_config *c, const struct adc_control *set,
                           struct model *m, const int64_t preset[ADC_CHANNELS],
                           const int64_t units[ADC_CHANNELS])
{
    if (!m->busy || --m->left > 0)
        return 0;
    int i = m->channel;
    uint32_t events = DONE;
    m->conversions++;
    m->busy = false;
    m->code[i] = model_code(c->bits, set->range[i], m->held);
    if (model_compare(c, set, m, preset[i]))
        events += 1u << i;
    m->got[i] = true;
    int missing = 0, members = 0;
    for (int n = 0; n < ADC_CHANNELS; n++) {
        bool member = set->tagged >> n & 1;
        m->got[n] = m->got[n] && member;
        members += member;
        missing += member && !m->got[n];
    }
    if (members > 0 && missing == 0) {
        events += TAG;
        memset(m->got, 0, sizeof m->got);
    }
    if (set->mode == ADC_FREE_RUN && set->enabled != 0) {
        do
            m->channel = m->channel == 7 ? 0 : m->channel + 1;
        while (!(set->enabled & 1u << m->channel));
        model_sample(m, c->time, units);
    }
    return events;
}

/* The host changes one register; presets stay within their range. */
static void change(uint64_t *seed, struct adc_control *set, int64_t preset[ADC_CHANNELS])
{
    int i = (int)check_random(seed, 0, 7), what = (int)check_random(seed, 0, 9);
    uint32_t mask = (uint32_t)(check_random(seed, 0, 255) & check_random(seed, 0, 255));
    switch (what) {
    case 0:  set->mode = check_random(seed, 0, 3) == 0 ? ADC_SINGLE : ADC_FREE_RUN; break;
    case 1:  set->channel = i; break;
    case 2:  set->enabled = mask; break;
    case 3:  set->compare_on = mask | 1u << i; break;
    case 4:  set->tagged = mask; break;
    case 5:  set->ignored_bits = i % 4; break;
    case 6:  set->compare[i] = (enum adc_compare)(check_random(seed, 0, 2)); break;
    case 7:  set->range[i] = (enum adc_range)(check_random(seed, 0, 1)); break;
    default: preset[i] = check_random(seed, -40, 40);
    }
    if (set->range[i] == ADC_UNIPOLAR && preset[i] < 0)
        preset[i] = -preset[i];
    set->compare_volts[i] = (double)preset[i] * 10.0 / (1 << 17);
    CHECK_EQ(adc_check_control(set), ADC_OK);
}

/* How often each thing happened in all scenarios: they must not be idle. */
static int64_t done, compared, tagged, dropped, emptied;

static void same(const struct adc *a, const struct model *m, int64_t clock)
{
    CHECK_EQ(a->busy, m->busy);
    CHECK_EQ(adc_due(a), m->busy ? clock + m->left : INT64_MAX);
    CHECK_EQ(a->conversions, m->conversions);
    CHECK(memcmp(a->code, m->code, sizeof m->code) == 0);
    if (m->busy) {
        CHECK_EQ(a->channel, m->channel);
        CHECK(a->held == (double)m->held * 10.0 / (1 << 17));
    }
}

static void scenario(uint64_t seed)
{
    struct adc_config c = { 12 + 2 * (int32_t)check_random(&seed, 0, 2),
                            (int32_t)check_random(&seed, 1, 12) };
    struct adc_control set = { .mode = ADC_FREE_RUN, .enabled = 0xFF, .compare_on = 0xFF };
    struct adc a = { 0 };
    struct model m = { 0 };
    int64_t units[ADC_CHANNELS] = { 0 }, preset[ADC_CHANNELS] = { 0 };
    double volts[ADC_CHANNELS] = { 0 };
    int64_t swing = c.bits == 12 ? 200 : 50;
    for (int64_t clock = 1; clock <= 1500; clock++) {
        int mover = (int)check_random(&seed, 0, 7);
        units[mover] = check_random(&seed, -swing, swing);
        if (check_random(&seed, 0, 50) == 0)
            units[mover] *= 10000; /* beyond the range */
        volts[mover] = (double)units[mover] * 10.0 / (1 << 17);
        uint32_t want = model_tick(&c, &set, &m, preset, units);
        uint32_t got = adc_due(&a) == clock ? adc_finish(&c, &set, &a, volts) : 0;
        CHECK_EQ(got, want);
        done += (want & DONE) != 0;
        tagged += (want & TAG) != 0;
        compared += (want & 0xFF) != 0;
        emptied += (want & DONE) != 0 && set.mode == ADC_FREE_RUN && !m.busy;
        int64_t write = check_random(&seed, 0, 99);
        if (write < 12)
            change(&seed, &set, preset);
        if (write >= 10 && write < 13) {
            dropped += m.busy;
            adc_start(&c, &set, &a, volts, clock);
            model_start(&c, &set, &m, units);
        }
        if (write == 13 && clock % 4 == 0) {
            adc_stop(&a);
            m.busy = false;
        }
        same(&a, &m, clock);
    }
}

/* Each status has a text of its own. */
static void texts(void)
{
    for (int a = ADC_OK + 1; a <= ADC_BAD_IGNORED; a++)
        for (int b = ADC_OK + 1; b < a; b++)
            CHECK(strcmp(adc_status_text((enum adc_status)a), adc_status_text((enum adc_status)b)));
}

int main(void)
{
    codes();
    texts();
    settings();
    single();
    free_run();
    changed_mode();
    comparator();
    predecessors();
    group();
    for (uint64_t seed = 1; seed <= 1500; seed++)
        scenario(seed * 7919);
    CHECK(done > 200000 && compared > 5000 && tagged > 8000 && dropped > 30000 && emptied > 800);
    return check_result();
}
