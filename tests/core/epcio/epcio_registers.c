/* Register writes: what is out of range is refused with a code and changes nothing; the map reaches
 * every register; module resets. */
#include "epcio_card.h"
#include "register_map.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* The call must be refused with this status and leave the card as it was. */
#define REFUSED(call, want) \
    do { \
        struct epcio before = card; \
        CHECK_EQ(call, want); \
        CHECK(memcmp(&before, &card, sizeof card) == 0); \
        CHECK(strlen(epcio_status_text((enum epcio_status)(want))) > 9); \
    } while (0)

static void dda_and_fifo(void)
{
    struct epcio card = card_stocked(5, 2);
    int32_t n = 77;
    REFUSED(epcio_set_dda(&card, 9, 1), EPCIO_BAD_LENGTH);
    REFUSED(epcio_set_dda(&card, 16, 1), EPCIO_BAD_LENGTH);
    REFUSED(epcio_set_dda(&card, 10, 0), EPCIO_BAD_DIVIDER);
    REFUSED(epcio_set_dda(&card, 10, 65536), EPCIO_BAD_DIVIDER);
    REFUSED(epcio_set_minimum(&card, -1), EPCIO_BAD_MINIMUM);
    REFUSED(epcio_set_minimum(&card, 63), EPCIO_BAD_MINIMUM);
    REFUSED(epcio_erase_last(&card, 6, 1, &n), EPCIO_BAD_AXIS);
    REFUSED(epcio_erase_last(&card, -1, 1, &n), EPCIO_BAD_AXIS);
    REFUSED(epcio_erase_last(&card, 0, -1, &n), EPCIO_BAD_COUNT);
    REFUSED(epcio_shift_out(&card, 6, &n), EPCIO_BAD_AXIS);
    struct bus_write w = { .seq = 1, .count = 17 };
    REFUSED(epcio_post(&card, &w), EPCIO_BAD_COUNT);
    w.count = -1;
    REFUSED(epcio_post(&card, &w), EPCIO_BAD_COUNT);
    CHECK_EQ(n, 77);
    CHECK_EQ(epcio_erase_last(&card, 1, 2, &n), EPCIO_OK);
    CHECK_EQ(n, 2);
    CHECK_EQ(card.fifo[1].stock, 3);
    CHECK_EQ(card.fifo[0].stock, 5);
    CHECK_EQ(card.irq.flags[IRQ_DDA], 0);
    CHECK_EQ(epcio_shift_out(&card, 1, &n), EPCIO_OK);
    CHECK_EQ(n, 100);
    CHECK_EQ(card.irq.flags[IRQ_DDA], 2); /* the stock has fallen to 2 */
    CHECK_EQ(epcio_erase_last(&card, 1, 9, &n), EPCIO_OK);
    CHECK_EQ(n, 2);
    REFUSED(epcio_shift_out(&card, 1, &n), EPCIO_FIFO_EMPTY);
}

static void encoders_and_loops(void)
{
    struct epcio card = card_on();
    struct encoder_config e = card.config.encoder[0];
    e.rate = 3;
    REFUSED(epcio_set_encoder(&card, 0, &e), EPCIO_ENCODER + ENCODER_BAD_RATE);
    e.rate = 4;
    REFUSED(epcio_set_encoder(&card, 9, &e), EPCIO_BAD_AXIS);
    REFUSED(epcio_clear_encoders(&card, 1u << 9), EPCIO_BAD_MASK);
    REFUSED(epcio_set_compare(&card, 9, true, 0), EPCIO_BAD_AXIS);
    REFUSED(epcio_set_compare(&card, -1, true, 0), EPCIO_BAD_AXIS);
    REFUSED(epcio_set_latch(&card, 9, 1, false), EPCIO_BAD_AXIS);
    REFUSED(epcio_set_latch(&card, 0, 1u << LATCH_SOURCES, false), EPCIO_BAD_MASK);
    REFUSED(epcio_clear_loops(&card, 1u << 7), EPCIO_BAD_MASK);
    struct epcio_host host = { .gain = { 65535 } };
    CHECK_EQ(epcio_set_host(&card, &host), EPCIO_OK);
    host.gain[5] = 65536;
    REFUSED(epcio_set_host(&card, &host), EPCIO_BAD_GAIN);
    host.gain[5] = -1;
    REFUSED(epcio_set_host(&card, &host), EPCIO_BAD_GAIN);
    host.gain[5] = 0;
    host.volts[7] = NAN;
    REFUSED(epcio_set_host(&card, &host), EPCIO_BAD_VOLTS);
    host.volts[7] = INFINITY;
    REFUSED(epcio_set_host(&card, &host), EPCIO_BAD_VOLTS);
}

static void analog_and_io(void)
{
    struct epcio card = card_on();
    REFUSED(epcio_set_trigger(&card, 8, &(struct analog_trigger){ 1, 0.0 }), EPCIO_BAD_AXIS);
    REFUSED(epcio_set_trigger(&card, 0, &(struct analog_trigger){ 1, 10.1 }), EPCIO_BAD_VOLTS);
    REFUSED(epcio_set_trigger(&card, 0, &(struct analog_trigger){ 1, NAN }), EPCIO_BAD_VOLTS);
    struct adc_control adc = { .channel = 8 };
    REFUSED(epcio_set_adc(&card, &adc), EPCIO_ADC + ADC_BAD_CHANNEL);
    struct local_io_control local = card.local_control;
    local.servo_on = 64;
    REFUSED(epcio_set_local_io(&card, &local), EPCIO_LOCAL_IO + LOCAL_IO_BAD_SERVO_ON);
    struct remote_io_control remote = { .retry_limit = 256 };
    REFUSED(epcio_set_remote_io(&card, 0, &remote), EPCIO_REMOTE_IO + REMOTE_IO_BAD_RETRY);
    remote.retry_limit = 1;
    REFUSED(epcio_set_remote_io(&card, 2, &remote), EPCIO_BAD_AXIS);
    REFUSED(epcio_set_timer(&card, true, 0), EPCIO_TIMER + TIMER_BAD_PERIOD);
    REFUSED(epcio_set_timer(&card, true, TIMER_PERIOD_MAX + 1), EPCIO_TIMER + TIMER_BAD_PERIOD);
    REFUSED(epcio_set_watchdog(&card, true, 0, 1), EPCIO_TIMER + TIMER_BAD_VALUE);
    REFUSED(epcio_set_watchdog(&card, true, 1, 0), EPCIO_TIMER + TIMER_BAD_RESET);
    REFUSED(epcio_reset_module(&card, (enum epcio_module)0), EPCIO_BAD_MODULE);
    REFUSED(epcio_reset_module(&card, (enum epcio_module)11), EPCIO_BAD_MODULE);
}

static void configuration(void)
{
    struct epcio card = card_on();
    const struct epcio_config good = epcio_default_config();
    struct epcio_config c = good;
    c.pulse[5].width = 0;
    REFUSED(epcio_reset(&card, &c), EPCIO_PULSE + PULSE_BAD_WIDTH);
    c = good;
    c.encoder[8].rate = 5;
    REFUSED(epcio_reset(&card, &c), EPCIO_ENCODER + ENCODER_BAD_RATE);
    c = good;
    c.loop.scale = 16;
    REFUSED(epcio_reset(&card, &c), EPCIO_BAD_SCALE);
    c = good;
    c.loop.limit = 0;
    REFUSED(epcio_reset(&card, &c), EPCIO_BAD_LIMIT);
    c.loop.limit = 32768;
    REFUSED(epcio_reset(&card, &c), EPCIO_BAD_LIMIT);
    c = good;
    c.trim[7].gain = 1.6;
    REFUSED(epcio_reset(&card, &c), EPCIO_BAD_TRIM);
    c = good;
    c.trim[0].offset = NAN;
    REFUSED(epcio_reset(&card, &c), EPCIO_BAD_TRIM);
    c = good;
    c.adc.bits = 13;
    REFUSED(epcio_reset(&card, &c), EPCIO_ADC + ADC_BAD_BITS);
    c = good;
    c.remote.time = 0;
    REFUSED(epcio_reset(&card, &c), EPCIO_REMOTE_IO + REMOTE_IO_BAD_TIME);
}

/* Each row: a value that is taken, and one that is refused, and why. */
static void map(void)
{
    static const struct {
        int32_t address;
        double good, bad;
        int status;
    } ROW[] = {
        { REG_FIFO_ERASE, 1, -1, EPCIO_BAD_COUNT },
        { REG_ENC_FORMAT + 8, 1, 4, EPCIO_ENCODER + ENCODER_BAD_FORMAT },
        { REG_ENC_RATE, 2, 3, EPCIO_ENCODER + ENCODER_BAD_RATE },
        { REG_ENC_WIRING + 3, 12, 16, EPCIO_ENCODER + ENCODER_BAD_WIRING },
        { REG_ENC_FILTER, 40, -1, EPCIO_ENCODER + ENCODER_BAD_FILTER },
        { REG_ENC_COMPARE + 1, -5000, 3e9, EPCIO_BAD_VALUE },
        { REG_ENC_COMPARE_ON + 1, 1, 2, EPCIO_BAD_VALUE },
        { REG_ENC_LATCH_LAST, 1, -1, EPCIO_BAD_VALUE },
        { REG_ENC_LATCH, 0x6200, 0x8000, EPCIO_BAD_MASK },
        { REG_DAC_TRIGGER_VOLTS + 7, -9.99, -10.01, EPCIO_BAD_VOLTS },
        { REG_DAC_TRIGGER + 7, 4294967295.0, -1, EPCIO_BAD_MASK },
        { REG_ADC_MODE, 1, 2, EPCIO_ADC + ADC_BAD_MODE },
        { REG_ADC_CHANNEL, 7, 8, EPCIO_ADC + ADC_BAD_CHANNEL },
        { REG_ADC_ENABLED, 255, 256, EPCIO_ADC + ADC_BAD_MASK },
        { REG_ADC_COMPARE_ON, 3, 999, EPCIO_ADC + ADC_BAD_MASK },
        { REG_ADC_IGNORED_BITS, 3, 4, EPCIO_ADC + ADC_BAD_IGNORED },
        { REG_ADC_TAGGED, 255, -1, EPCIO_ADC + ADC_BAD_MASK },
        { REG_ADC_RUN, 1, 7, EPCIO_BAD_VALUE },
        { REG_ADC_RANGE + 2, 1, 2, EPCIO_ADC + ADC_BAD_RANGE },
        { REG_ADC_COMPARE + 2, 2, 3, EPCIO_ADC + ADC_BAD_COMPARE },
        { REG_ADC_COMPARE_VOLTS + 2, 5.25, -0.1, EPCIO_ADC + ADC_BAD_VOLTS },
        { REG_LIO_OUTPUTS, 255, 256, EPCIO_LOCAL_IO + LOCAL_IO_BAD_LDO },
        { REG_LIO_SERVO_ON, 63, 64, EPCIO_LOCAL_IO + LOCAL_IO_BAD_SERVO_ON },
        { REG_LIO_POSITION_READY, 1, 2, EPCIO_BAD_VALUE },
        { REG_LIO_STOP_ENABLE, 1, -1, EPCIO_BAD_VALUE },
        { REG_LIO_GATE, 1, 3, EPCIO_BAD_VALUE },
        { REG_LIO_DEDICATED, 127, 128, EPCIO_LOCAL_IO + LOCAL_IO_BAD_DEDICATED },
        { REG_LIO_LDI_EDGE + 7, 2, 3, EPCIO_LOCAL_IO + LOCAL_IO_BAD_EDGE },
        { REG_LIO_DFI_EDGE + 6, 1, -1, EPCIO_LOCAL_IO + LOCAL_IO_BAD_EDGE },
        { REG_TIMER_PERIOD, 40000, -1, EPCIO_TIMER + TIMER_BAD_PERIOD },
        { REG_WATCHDOG_RESET, 4294967295.0, 0, EPCIO_TIMER + TIMER_BAD_RESET },
        { REG_WATCHDOG_VALUE, 65535, 65536, EPCIO_TIMER + TIMER_BAD_VALUE },
        { REG_RIO_RETRY + 1, 255, 256, EPCIO_REMOTE_IO + REMOTE_IO_BAD_RETRY },
        { REG_RIO_ENABLED + 1, 7, 8, EPCIO_REMOTE_IO + REMOTE_IO_BAD_ENABLED },
        { REG_RIO_EDGE + 23, 2, 3, EPCIO_REMOTE_IO + REMOTE_IO_BAD_EDGE },
        { REG_RIO_OUT + 23, 65535, 65536, EPCIO_BAD_VALUE },
        { REG_MODULE_RESET, 3, 0, EPCIO_BAD_MODULE },
    };
    struct epcio card = card_stocked(9, 0);
    for (size_t i = 0; i < sizeof ROW / sizeof ROW[0]; i++) {
        CHECK_EQ(epcio_write(&card, ROW[i].address, ROW[i].good), EPCIO_OK);
        REFUSED(epcio_write(&card, ROW[i].address, ROW[i].bad), ROW[i].status);
        REFUSED(epcio_write(&card, ROW[i].address, NAN), EPCIO_BAD_VALUE);
        REFUSED(epcio_write(&card, ROW[i].address, 1e300), EPCIO_BAD_VALUE);
        if (check_failures > 0)
            printf("register 0x%03X\n", (unsigned)ROW[i].address);
    }
    REFUSED(epcio_write(&card, REG_ENC_RATE, 1.5), EPCIO_BAD_VALUE);
    REFUSED(epcio_write(&card, REG_ENC_RATE + 9, 1), EPCIO_BAD_REGISTER);
    REFUSED(epcio_write(&card, 0, 1), EPCIO_BAD_REGISTER);
    REFUSED(epcio_write(&card, -1, 1), EPCIO_BAD_REGISTER);
    REFUSED(epcio_write(&card, REG_MODULE_RESET + 1, 1), EPCIO_BAD_REGISTER);
    /* and the values have arrived */
    CHECK_EQ(card.fifo[0].stock, 8);
    CHECK_EQ(card.encoder[0].config.rate, 2);
    CHECK_EQ(card.encoder[1].compare, -5000);
    CHECK(card.encoder[1].compare_on && card.latch[0].keep_last && card.adc.busy);
    CHECK_EQ(card.analog.trigger[7].source, UINT32_MAX);
    CHECK(card.adc_control.compare_volts[2] == 5.25);
    CHECK_EQ(card.remote_control[1].out[2][3], 65535);
    CHECK_EQ(card.remote_control[1].edge[2][3], 2);
    CHECK(card.timer.on && card.watchdog.on && card.remote_control[1].on);
}

/* Addresses do not overlap: every address belongs to one register. */
static void map_is_disjoint(void)
{
    static unsigned char owners[0x1000];
#define EPCIO_REGISTER(first, name, count) \
    for (int i = 0; i < (count); i++) \
        owners[(first) + i]++;
    EPCIO_REGISTERS(EPCIO_REGISTER)
#undef EPCIO_REGISTER
    for (int i = 0; i < 0x1000; i++)
        CHECK(owners[i] <= 1);
}

static void module_resets(void)
{
    struct epcio card = card_stocked(9, 0);
    const struct epcio fresh = card_on();
    int bad;
    double phase[EPCIO_ENCODERS] = { 0 };
    card_sample(&card, phase, &bad);
    epcio_write(&card, REG_ADC_ENABLED, 255);
    epcio_write(&card, REG_ADC_MODE, 1);
    epcio_write(&card, REG_ADC_RUN, 1);
    epcio_write(&card, REG_TIMER_PERIOD, 500);
    epcio_write(&card, REG_WATCHDOG_VALUE, 60);
    epcio_write(&card, REG_LIO_OUTPUTS, 5);
    epcio_write(&card, REG_RIO_ENABLED, 7);
    epcio_write(&card, REG_DAC_TRIGGER, 1);
    epcio_write(&card, REG_ENC_LATCH, 1);
    epcio_write(&card, REG_ENC_COMPARE_ON, 1);
    card.host.gain[2] = 60;
    card.host.volts[2] = 3.0;
    epcio_advance(&card, 4000);
    phase[1] = 3.0;
    card_sample(&card, phase, &bad);
    CHECK_EQ(card.encoder[1].count, 12);
    CHECK(card.irq.flags[IRQ_ADC] != 0 && card.irq.flags[IRQ_LIO] != 0);
    CHECK_EQ(epcio_reset_module(&card, EPCIO_RESET_ENC), EPCIO_OK);
    CHECK_EQ(card.encoder[1].count, 0);
    CHECK(!card.encoder[0].compare_on && card.latch[0].source == 0);
    CHECK(card.adc.busy && card.timer.on);
    CHECK_EQ(epcio_reset_module(&card, EPCIO_RESET_PERI), EPCIO_OK);
    CHECK(!card.adc.busy && !card.timer.on && !card.remote_control[0].on);
    CHECK_EQ(card.fifo[0].stock, 6);
    CHECK_EQ(epcio_reset_module(&card, EPCIO_RESET_ALL), EPCIO_OK);
    CHECK_EQ(card.fifo[0].stock, 0);
    CHECK_EQ(card.dda.next_ticks, 1 << EPCIO_RESET_LENGTH);
    CHECK_EQ(card.host.gain[2], 0);
    CHECK(memcmp(&card.adc_control, &fresh.adc_control, sizeof fresh.adc_control) == 0);
    CHECK(memcmp(&card.analog, &fresh.analog, sizeof fresh.analog) == 0);
    CHECK(memcmp(card.irq.flags, fresh.irq.flags, sizeof fresh.irq.flags) == 0);
    epcio_advance(&card, 100000);
    int64_t pulses[EPCIO_AXES];
    epcio_pulses(&card, pulses);
    CHECK_EQ(pulses[0], 300); /* the DDA time in progress ended */
}

/* 0 ends conversions by the register that 1 began them by: nothing is due, none comes. */
static void conversions_stop(void)
{
    struct epcio card = card_on();
    epcio_write(&card, REG_ADC_ENABLED, 255);
    epcio_write(&card, REG_ADC_MODE, 1); /* free run */
    CHECK_EQ(epcio_write(&card, REG_ADC_RUN, 1), EPCIO_OK);
    epcio_advance(&card, 4000);
    CHECK(card.irq.flags[IRQ_ADC] != 0 && adc_due(&card.adc) < INT64_MAX);
    CHECK_EQ(epcio_write(&card, REG_ADC_RUN, 0), EPCIO_OK);
    const struct adc stopped = card.adc;
    epcio_advance(&card, 40000);
    CHECK_EQ(adc_due(&card.adc), INT64_MAX);
    CHECK(memcmp(&card.adc, &stopped, sizeof stopped) == 0);
}

/* What stopped the pulses is gone with the module's reset: they go on by themselves. */
static void pulses_go_on_behind_a_reset(void)
{
    for (int expired = 0; expired < 2; expired++) {
        struct epcio card = card_stocked(9, 0);
        int64_t stopped[EPCIO_AXES], gone[EPCIO_AXES];
        epcio_advance(&card, 4000);
        if (expired) {
            CHECK_EQ(epcio_write(&card, REG_TIMER_PERIOD, 100), EPCIO_OK);
            CHECK_EQ(epcio_write(&card, REG_WATCHDOG_VALUE, 1), EPCIO_OK);
            epcio_advance(&card, 5000);
            CHECK(card.watchdog.expired);
        } else {
            CHECK_EQ(epcio_write(&card, REG_LIO_GATE, 0), EPCIO_OK);
        }
        epcio_pulses(&card, stopped);
        epcio_advance(&card, card.clock + 200000);
        epcio_pulses(&card, gone);
        CHECK_EQ(gone[0], stopped[0]);
        CHECK_EQ(epcio_reset_module(&card, EPCIO_RESET_LIO), EPCIO_OK);
        epcio_advance(&card, card.clock + 200000);
        epcio_pulses(&card, gone);
        CHECK(gone[0] > stopped[0]);
    }
}

int main(void)
{
    dda_and_fifo();
    encoders_and_loops();
    analog_and_io();
    configuration();
    map();
    map_is_disjoint();
    module_resets();
    conversions_stop();
    pulses_go_on_behind_a_reset();
    return check_result();
}
