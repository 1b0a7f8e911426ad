/* Error counter, position loop and DAC against their formulas. */
#include "epcio_card.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* code = error gain / 2^scale, nearest, halves away from zero, 16 bit, against exact doubles. */
static void code_formula(uint64_t seed)
{
    for (int trial = 0; trial < 20000; trial++) {
        struct ploop_config c = { 32767, (int32_t)check_random(&seed, 0, 15) };
        int32_t error = (int32_t)check_random(&seed, -40000, 40000);
        int32_t gain = (int32_t)check_random(&seed, 0, 65535);
        if (trial % 3 == 0) {
            error = (int32_t)check_random(&seed, -300, 300);
            gain = (int32_t)check_random(&seed, 0, 200);
        }
        double exact = (double)error * gain / (1 << c.scale);
        double want = fmin(32767.0, fmax(-32768.0, round(exact)));
        CHECK_EQ(ploop_code(&c, error, gain), want);
        if (fabs(exact) < 32767.0)
            CHECK_EQ(ploop_code(&c, -error, gain), -ploop_code(&c, error, gain));
    }
    struct ploop_config c = { 32767, 1 };
    CHECK_EQ(ploop_code(&c, 1, 1), 1);
    CHECK_EQ(ploop_code(&c, -1, 1), -1);
    CHECK_EQ(ploop_code(&c, INT32_MAX, 65535), 32767);
    CHECK_EQ(ploop_code(&c, -INT32_MAX, 65535), -32768);
}

static void error_counter(void)
{
    struct ploop_config c = { 100, 0 };
    struct ploop p = { 0 };
    CHECK(!ploop_tick(&c, &p, false, 1000, 0));
    CHECK_EQ(p.error, 0);
    CHECK(!ploop_tick(&c, &p, true, 1000, 300)); /* switching on starts from zero */
    CHECK_EQ(p.error, 0);
    CHECK(!ploop_tick(&c, &p, true, 1010, 295));
    CHECK_EQ(p.error, 15);
    CHECK(!ploop_tick(&c, &p, true, 1099, 300));
    CHECK(ploop_tick(&c, &p, true, 1100, 300));  /* reaches the limit */
    CHECK(!ploop_tick(&c, &p, true, 1200, 300)); /* stays beyond it */
    CHECK(!ploop_tick(&c, &p, true, 1099, 300));
    CHECK(ploop_tick(&c, &p, true, 900, 300)); /* the other side */
    CHECK_EQ(p.error, -100);
    CHECK(!ploop_tick(&c, &p, true, 4000000000000, -4000000000000));
    CHECK_EQ(p.error, INT32_MAX);
    ploop_tick(&c, &p, false, 0, 0);
    CHECK_EQ(p.error, 0);
    CHECK(!ploop_tick(&c, &p, true, 5, 5));
    CHECK_EQ(p.error, 0);
}

static void dac(void)
{
    CHECK_EQ(analog_code(0.0), 0);
    CHECK_EQ(analog_code(10.0), 32767);
    CHECK_EQ(analog_code(-10.0), -32768);
    CHECK_EQ(analog_code(1e300), 32767);
    CHECK_EQ(analog_code(-INFINITY), -32768);
    CHECK_EQ(analog_code(NAN), 0);
    CHECK_EQ(analog_code(5.0), 16384);
    CHECK_EQ(analog_code(0.5 * ANALOG_LSB), 1);
    CHECK_EQ(analog_code(-0.5 * ANALOG_LSB), -1);
    CHECK_EQ(analog_code(0.49999 * ANALOG_LSB), 0);
    CHECK(analog_volts(-32768) == -10.0);
    CHECK(analog_volts(32767) == 10.0 - 20.0 / 65536.0);
    for (int32_t code = INT16_MIN; code <= INT16_MAX; code += 7)
        CHECK_EQ(analog_code(analog_volts(code)), code);
    for (double volts = -10.0; volts < 9.999; volts += 0.001237)
        CHECK(fabs(analog_volts(analog_code(volts)) - volts) <= 0.5 * ANALOG_LSB);
}

/* A closed loop on a motor that follows the voltage exactly: the error settles at v / Kv with
 * Kv = gain / 2^scale * LSB * counts per second per volt, one period of delay or not. */
static void velocity_error(int32_t gain)
{
    struct epcio card = card_on();
    int bad;
    epcio_set_dda(&card, 10, 40); /* 1.024 ms */
    card.host.gain[0] = gain;
    card.host.loop_on[0] = card.host.dac_loop[0] = true;
    const int32_t command = 50;            /* pulses per DDA time: 48828 /s */
    const double speed_per_volt = 50000.0; /* counts/s per volt */
    double phase[EPCIO_ENCODERS] = { 0 };
    for (int64_t k = 0; k < 20000; k++) { /* 2 s at 100 us */
        epcio_advance(&card, k * 4000);
        epcio_convert(&card);
        card_sample(&card, phase, &bad);
        while (card.fifo[0].stock < 10)
            epcio_write_frame(&card, (int32_t[6]){ command });
        epcio_control(&card);
        phase[0] += analog_volts(card.analog.code[0]) * speed_per_volt / 4 * 1e-4;
    }
    double kv = gain / 64.0 * ANALOG_LSB * speed_per_volt;
    double want = command / 1.024e-3 / kv;
    CHECK(fabs(card.loop[0].error - want) <= 3.0); /* pulses and counts are whole numbers */
    CHECK(want > 50.0);
    CHECK_EQ(card.underflows[0], 0);
}

/* Loop and software source; an unused axis gives nothing; a code waits for the next instant. */
static void source_select(void)
{
    struct epcio_config config = epcio_default_config();
    config.loop = (struct ploop_config){ 100, 0 };
    for (int i = 2; i < EPCIO_AXES; i++)
        config.active[i] = false;
    struct epcio card;
    int bad;
    double phase[EPCIO_ENCODERS] = { 0 };
    epcio_reset(&card, &config);
    for (int i = 0; i < 3; i++) {
        card.host.gain[i] = 10;
        card.host.volts[i] = 2.5;
        card.host.loop_on[i] = true;
    }
    card.host.volts[7] = -2.5;
    card.host.dac_loop[0] = true;
    card_sample(&card, phase, &bad);
    epcio_control(&card);
    phase[0] = -3.0;
    card_sample(&card, phase, &bad);
    epcio_control(&card);
    CHECK_EQ(card.analog.code[0], 0);
    epcio_convert(&card);
    CHECK_EQ(card.analog.code[0], 120);
    CHECK_EQ(card.analog.code[1], 8192);
    CHECK_EQ(card.analog.code[2], 0);
    CHECK_EQ(card.analog.code[6], 0);
    CHECK_EQ(card.analog.code[7], -8192);
}

/* The seventh error counter: the host's command less counter 7, its own overflow bit, whatever the
 * command does at the ends of its 32 bits; the other six and the voltages do not know of it. */
static void seventh(int32_t start, int way)
{
    enum { LIMIT = 300, BIT = 1u << (IRQ_PCL_OV + 6) };
    struct epcio_config config = epcio_default_config();
    config.loop.limit = LIMIT;
    struct epcio card;
    double phase[EPCIO_ENCODERS] = { 0 };
    int64_t counted = 0, command = 0; /* since it was switched on */
    int bad, fired = 0;
    bool over = false;
    CHECK_EQ(epcio_reset(&card, &config), EPCIO_OK);
    for (int k = 1; k >= 0; k--) { /* it is off */
        card.host.command = start - way * 50 * k;
        card_sample(&card, phase, &bad);
        epcio_control(&card);
        CHECK_EQ(card.loop[6].error, 0);
    }
    card.host.loop_on[6] = true;
    for (int k = 0; k < 200; k++) {
        card_acknowledge(&card, IRQ_PCL, 0x7F, 0x7F);
        epcio_advance(&card, (k + 1) * 4000);
        epcio_convert(&card);
        card_sample(&card, phase, &bad);
        epcio_control(&card);
        CHECK_EQ(card.loop[6].error, command - counted);
        const bool was = over;
        over = llabs(command - counted) >= LIMIT;
        CHECK_EQ(card.irq.flags[IRQ_PCL], over && !was ? BIT : 0);
        CHECK_EQ(card.irq.line, over && !was);
        fired += over && !was;
        for (int i = 0; i < ANALOG_DACS; i++)
            CHECK_EQ(card.analog.code[i], 0);
        for (int i = 0; i < EPCIO_AXES; i++)
            CHECK_EQ(card.loop[i].error, 0);
        command += way * 5 * (k % 7);
        counted += way * 4 * (k % 50 < 25 ? 0 : 8); /* standstill, then faster */
        card.host.command = (int32_t)((uint32_t)start + (uint32_t)(int32_t)command);
        phase[6] = (double)counted / 4.0;
        phase[0] = phase[7] = phase[8] = 1000.0; /* of others */
    }
    CHECK(fired > 0);
    const int32_t error = card.loop[6].error;
    CHECK(error != 0);
    CHECK_EQ(epcio_clear_loops(&card, 1u << 6), EPCIO_OK);
    CHECK_EQ(card.loop[6].error, 0);
    epcio_control(&card);
    CHECK_EQ(card.loop[6].error, 0); /* begins anew */
    CHECK_EQ(epcio_reset_module(&card, EPCIO_RESET_PCL), EPCIO_OK);
    CHECK(!card.host.loop_on[6]);
}

int main(void)
{
    code_formula(271828);
    error_counter();
    dac();
    velocity_error(60);
    velocity_error(200);
    source_select();
    seventh(0, 1);
    seventh(INT32_MAX - 100, 1);
    seventh(INT32_MIN + 100, -1);
    return check_result();
}
