/* fmi_cases - tests of the FMI layer that are common to both standards. The including file defines
 * the call_ functions (0 is OK, 3 is Error) by the functions of its standard. */
#ifndef FMI_CASES_H
#define FMI_CASES_H

#include <stdio.h>
#include <string.h>

static char said[8192]; /* the latest message */
static int failures;

#define CHECK(condition) \
    do { \
        if (!(condition)) { \
            printf("%s:%d: %s (message: %s)\n", __FILE__, __LINE__, #condition, said); \
            failures++; \
        } \
    } while (0)

/* The call must be refused with these words in the message. */
#define CHECK_REFUSED(call, words) \
    do { \
        said[0] = '\0'; \
        CHECK((call) == 3); \
        CHECK(strstr(said, words)); \
    } while (0)

static void *make(void)
{
    void *c = call_instantiate("one", FMU_TOKEN, "/tmp/resources");
    CHECK(c != NULL);
    return c;
}

static void *make_running(double start, double stop)
{
    void *c = make();
    CHECK(call_enter(c, start, stop) == 0);
    CHECK(call_exit(c) == 0);
    return c;
}

static double y_of(void *c)
{
    double y[2] = { 0 };
    CHECK(call_get_y(c, y) == 0);
    return y[0];
}

/* Random sequences of calls: the layer must accept exactly what this table allows, which is taken
 * from the standards. Rows are the modes of the instance. */
enum call {
    ENTER,
    EXIT,
    STEP,
    TERMINATE,
    RESET,
    SET_GAIN,
    SET_TRIM,
    SET_U,
    GET_GAIN,
    GET_Y,
    CALLS
};
enum stand { NEW, INITIALIZING, RUNNING, ENDED, FAILED };

static bool allowed(enum stand s, enum call call)
{
    switch (call) {
    case ENTER:     return s == NEW;
    case EXIT:      return s == INITIALIZING;
    case STEP:      return s == RUNNING;
    case TERMINATE: return s == RUNNING;
    case SET_GAIN:  return s == NEW || s == INITIALIZING;
    case SET_TRIM:
    case SET_U:     return s == NEW || s == INITIALIZING || s == RUNNING;
    case GET_Y:     return s != NEW;
    default:        return true;
    }
}

static int perform(void *c, enum call call, double time)
{
    double value = 1.0, y[2], u[3] = { 1.0, 2.0, 3.0 };
    switch (call) {
    case ENTER:     return call_enter(c, 0.0, -1.0);
    case EXIT:      return call_exit(c);
    case STEP:      return call_step(c, time, 1e-3);
    case TERMINATE: return call_terminate(c);
    case RESET:     return call_reset(c);
    case SET_GAIN:  return call_set_real(c, REF_GAIN, 1, &value);
    case SET_TRIM:  return call_set_real(c, REF_TRIM, 1, &value);
    case SET_U:     return call_set_real(c, REF_U, 3, u);
    case GET_GAIN:  return call_get_real(c, REF_GAIN, 1, &value);
    default:        return call_get_y(c, y);
    }
}

static void test_order_of_calls(void)
{
    static const enum stand after[CALLS] = {
        [ENTER] = INITIALIZING, [EXIT] = RUNNING, [TERMINATE] = ENDED, [RESET] = NEW
    };
    unsigned random = 1; /* linear congruential generator of the C standard's example */
    void *c = make();
    enum stand s = NEW;
    double time = 0.0;
    int seen[FAILED][CALLS] = { 0 };
    for (int i = 0; i < 20000; i++) {
        random = random * 1103515245u + 12345u;
        enum call call = (random >> 16) % CALLS;
        said[0] = '\0';
        int status = perform(c, call, time);
        bool good = allowed(s, call);
        CHECK(status == (good ? 0 : 3));
        CHECK(good || said[0]);
        seen[s][call]++;
        if (good && (call <= EXIT || call == TERMINATE || call == RESET)) {
            s = after[call];
            time = 0.0;
        } else if (good && call == STEP) {
            time += 1e-3;
        }
    }
    for (int k = 0; k < FAILED * CALLS; k++) {
        CHECK(seen[k / CALLS][k % CALLS] > 0);
    }
    call_free(c);
}

static void test_messages_of_wrong_order(void)
{
    void *c = make();
    CHECK_REFUSED(call_step(c, 0.0, 1e-3), "DoStep is not allowed in Instantiated, only in Step");
    CHECK_REFUSED(call_exit(c), "not allowed in Instantiated, only in Initialization Mode");
    double y[2], gain = 1.0;
    CHECK_REFUSED(call_get_y(c, y), "y has no value before Initialization Mode");
    call_free(c);
    c = make_running(0.0, -1.0);
    CHECK_REFUSED(call_set_real(c, REF_GAIN, 1, &gain), "gain is a fixed parameter");
    CHECK_REFUSED(call_set_real(c, REF_Y, 2, y), "y is an output");
    call_free(c);
}

static void test_values_are_refused_whole(void)
{
    void *c = make();
    const double good[3] = { 7.0, 8.0, 9.0 }, bad[3] = { 4.0, NAN, 6.0 }, high = 101.0, low = -1.0;
    double back[3];
    CHECK(call_set_real(c, REF_U, 3, good) == 0);
    CHECK_REFUSED(call_set_real(c, REF_U, 3, bad), "u element 2 = ");
    CHECK(strstr(said, "not finite"));
    CHECK(call_get_real(c, REF_U, 3, back) == 0 && memcmp(back, good, sizeof back) == 0);
    const double infinite[3] = { 0.0, 0.0, -INFINITY };
    CHECK_REFUSED(call_set_real(c, REF_U, 3, infinite), "u element 3 = -inf is not finite");
    CHECK_REFUSED(call_set_real(c, REF_GAIN, 1, &high), "gain = 101 is above its maximum 100");
    CHECK_REFUSED(call_set_real(c, REF_GAIN, 1, &low), "gain = -1 is below its minimum 0");
    CHECK_REFUSED(call_set_n(c, 6), "n = 6 is above its maximum 5");
    CHECK(call_set_n(c, -5) == 0);
    CHECK_REFUSED(call_set_real(c, FMU_NREFS + 1, 1, &low), "unknown value reference 14");
    CHECK_REFUSED(call_set_real(c, REF_N, 1, &low), "n (value reference 6) is an integer, not a");
    char text[FMU_STRING_MAX + 1];
    memset(text, 'a', FMU_STRING_MAX);
    text[FMU_STRING_MAX] = '\0';
    CHECK_REFUSED(call_set_name(c, text), "name is longer than");
    CHECK_REFUSED(call_set_name(c, NULL), "name is NULL");
    text[FMU_STRING_MAX - 1] = '\0';
    CHECK(call_set_name(c, text) == 0);
    CHECK(strcmp(call_get_name(c), text) == 0);
    CHECK(call_set_name(c, call_get_name(c)) == 0); /* its own string */
    CHECK(strcmp(call_get_name(c), text) == 0);
    call_free(c);
}

/* Outputs in Initialization Mode follow parameters and inputs; only parameters call model_open
 * again. */
static void test_start_on_demand(void)
{
    void *c = make();
    double gain = 5.0, u[3] = { 10.0, 0.0, 0.0 }, y[2];
    CHECK(call_enter(c, 0.0, -1.0) == 0);
    CHECK(y_of(c) == 2.0);
    int before = opens;
    CHECK(call_set_real(c, REF_U, 3, u) == 0);
    CHECK(y_of(c) == 20.0 && opens == before);
    CHECK(call_set_real(c, REF_GAIN, 1, &gain) == 0);
    CHECK(y_of(c) == 50.0 && opens == before + 1);
    CHECK(call_get_y(c, y) == 0 && y[1] == 1.0);
    CHECK(call_set_name(c, "start fails") == 0);
    CHECK_REFUSED(call_exit(c), "name = start fails does not start");
    CHECK(call_set_name(c, "open fails") == 0);
    CHECK_REFUSED(call_get_y(c, y), "name = open fails does not open 100%");
    CHECK(call_set_name(c, "o\xe4 \xc3\xa4 \xe2\x82") == 0); /* Latin-1, UTF-8, one cut short */
    CHECK_REFUSED(call_get_y(c, y), "name = o? \xc3\xa4 ?? does not");
    CHECK(call_set_name(c, "end fails") == 0);
    CHECK(call_exit(c) == 0 && y_of(c) == 50.0);
    CHECK_REFUSED(call_terminate(c), "name = end fails does not end");
    CHECK(call_reset(c) == 0 && strcmp(call_get_name(c), "good") == 0);
    call_free(c);
}

/* At each start the model's memory is cleared: the dummy model checks it after steps and after a
 * state of another instance. */
static void test_a_start_finds_cleared_memory(void)
{
    void *a = make_running(0.0, -1.0), *b = make(), *state = NULL;
    CHECK(call_step(a, 0.0, 0.1) == 0 && call_get_state(a, &state) == 0);
    CHECK(call_reset(a) == 0 && call_enter(a, 0.0, -1.0) == 0 && call_exit(a) == 0);
    CHECK(call_set_state(b, state) == 0 && call_reset(b) == 0);
    CHECK(call_enter(b, 0.0, -1.0) == 0 && call_exit(b) == 0);
    call_free_state(a, &state);
    call_free(a);
    call_free(b);
}

static void test_steps(void)
{
    void *c = make_running(10.0, 10.5);
    const double bad[] = { 0.0, -1e-3, NAN, INFINITY, -INFINITY, 1e300 };
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        CHECK_REFUSED(call_step(c, 10.0, bad[i]), "communicationStepSize");
    }
    CHECK_REFUSED(call_step(c, 10.1, 1e-3), "10.1 s is not where the previous step ended, 10 s");
    CHECK_REFUSED(call_step(c, NAN, 1e-3), "is not where");
    CHECK_REFUSED(call_step(c, 10.0, 0.6), "passes stopTime 10.5 s");
    CHECK(y_of(c) == 2.0);
    CHECK(call_step(c, 10.0, 0.1) == 0 && y_of(c) == 2.0 + 2.0 * 1e8);
    CHECK(call_step(c, 10.1, 0.4 - 1e-15) == 0);
    const double u[3] = { 66.0, 0.0, 0.0 };
    call_free(c);
    c = make_running(0.0, -1.0);
    CHECK(call_set_real(c, REF_U, 3, u) == 0);
    CHECK_REFUSED(call_step(c, 0.0, 1e-3), "u = 66 does not step");
    CHECK_REFUSED(call_step(c, 0.0, 1e-3), "not allowed in the error state");
    CHECK(y_of(c) == 2.0);
    CHECK(call_reset(c) == 0);
    call_free(c);
}

/* An importer that adds up steps of 0.1 ms for one hour has an error of 2.7 us at the end and must
 * still reach it. */
static void test_an_hour_of_added_doubles(void)
{
    void *c = make_running(0.0, -1.0);
    const double step = 1e-4;
    double time = 0.0;
    bool good = true;
    for (int i = 0; i < 36000000 && good; i++) {
        good = call_step(c, time, step) == 0;
        time += step;
    }
    CHECK(good);
    CHECK(fabs(time - 3600.0) > 0.5 * FMU_TICK_NS * 1e-9);
    CHECK_REFUSED(call_step(c, time + 1e-6, step), "is not where");
    void *state = NULL;
    CHECK(call_get_state(c, &state) == 0);
    CHECK(call_step(c, 3600.0, step) == 0); /* the true time is right too */
    CHECK(call_set_state(c, state) == 0 && call_step(c, time, step) == 0);
    call_free_state(c, &state);
    call_free(c);
}

static void test_logging(void)
{
    void *c = make();
    const char *events[] = { "logEvents" }, *unknown[] = { "logEvents", "logAll" };
    said[0] = '\0';
    CHECK(call_enter(c, 0.0, -1.0) == 0 && y_of(c) == 2.0 && !said[0]); /* switched off */
    CHECK_REFUSED(call_log(c, true, 2, unknown), "unknown log category \"logAll\"");
    CHECK(call_log(c, true, 1, events) == 0);
    CHECK(call_set_n(c, 1) == 0 && y_of(c) == 2.0 && strstr(said, "started with gain 2"));
    CHECK(call_log(c, true, 0, NULL) == 0);
    CHECK(call_set_n(c, 2) == 0 && y_of(c) == 2.0 && strstr(said, "in \"/tmp/resources/\""));
    CHECK(call_log(c, false, 0, NULL) == 0);
    said[0] = '\0';
    CHECK(call_set_n(c, 3) == 0 && y_of(c) == 2.0 && !said[0]);
    CHECK_REFUSED(call_set_n(c, 7), "n = 7");
    call_free(c);
}

static void test_states(void)
{
    void *a = make_running(0.0, -1.0), *b = make(), *state = NULL, *copy = NULL;
    char bytes[4096];
    CHECK(call_step(a, 0.0, 1e-3) == 0);
    CHECK(call_get_state(a, &state) == 0);
    CHECK(call_step(a, 1e-3, 1e-3) == 0);
    double later = y_of(a);
    size_t size = call_state_size(a, state);
    CHECK(size > sizeof(struct vars) && size <= sizeof bytes);
    CHECK(call_serialize(a, state, bytes, size) == 0);
    CHECK_REFUSED(call_serialize(a, state, bytes, size - 1), "bytes given");
    CHECK_REFUSED(call_deserialize(b, bytes, size - 1, &copy), "bytes given");
    bytes[0]++;
    CHECK_REFUSED(call_deserialize(b, bytes, size, &copy), "the state is not one of Dummy");
    bytes[0]--;
    CHECK(call_deserialize(b, bytes, size, &copy) == 0);
    CHECK(call_set_state(b, copy) == 0); /* an instance that was never initialised */
    CHECK(call_step(b, 1e-3, 1e-3) == 0 && y_of(b) == later);
    int before = opens;
    CHECK(call_set_state(a, state) == 0 && opens == before); /* same parameters, same blob */
    CHECK(call_step(a, 1e-3, 1e-3) == 0 && y_of(a) == later);
    CHECK(call_get_state(a, &state) == 0); /* into the old place */
    CHECK_REFUSED(call_set_state(a, NULL), "state is NULL");
    call_free_state(a, &copy);
    CHECK(copy == NULL);
    call_free_state(a, &state);
    call_free(a);
    call_free(b);
}

/* A blob does not depend on tunable parameters: with another value of one the blob stays. */
static void test_state_with_another_tunable(void)
{
    void *c = make_running(0.0, -1.0), *state[2] = { NULL, NULL };
    const double trim = 7.0;
    CHECK(call_get_state(c, &state[0]) == 0);
    CHECK(call_set_real(c, REF_TRIM, 1, &trim) == 0 && call_get_state(c, &state[1]) == 0);
    const int before = opens;
    double y[2];
    for (int i = 0; i < 2; i++) {
        CHECK(call_set_state(c, state[i]) == 0 && opens == before);
        CHECK(call_step(c, 0.0, 1e-3) == 0);
        y[i] = y_of(c);
    }
    CHECK(y[1] == y[0] + trim);
    call_free_state(c, &state[0]);
    call_free_state(c, &state[1]);
    call_free(c);
}

/* Three added steps of 0.1 s end at 0.30000000000000004 s, which does not pass a stop time of 0.3
 * s. Half a clock more does not either, but a whole clock does. */
static void test_the_last_step(void)
{
    void *c = make_running(0.0, 0.3);
    double time = 0.0;
    for (int i = 0; i < 3; i++) {
        CHECK(call_step(c, time, 0.1) == 0);
        time += 0.1;
    }
    CHECK(time > 0.3);
    CHECK_REFUSED(call_step(c, time, FMU_TICK_NS * 1e-9), "passes stopTime 0.3 s");
    call_free(c);
    c = make_running(0.0, 1e-3 - 0.4e-9 * FMU_TICK_NS);
    CHECK(call_step(c, 0.0, 1e-3) == 0);
    call_free(c);
    c = make_running(0.0, 1e-3 - 0.6e-9 * FMU_TICK_NS);
    CHECK_REFUSED(call_step(c, 0.0, 1e-3), "passes stopTime");
    call_free(c);
}

/* These bytes must be refused with one message, and no state is made. */
static void check_damaged(void *c, const char *bytes, size_t size, const char *words)
{
    void *state = NULL;
    CHECK_REFUSED(call_deserialize(c, bytes, size, &state), words);
    CHECK(state == NULL);
}

/* The same for a change of any single bit. */
static void check_bits(void *c, char *bytes, size_t size)
{
    for (size_t i = 0; i < 8 * size; i++) {
        bytes[i / 8] ^= (char)(1 << i % 8);
        check_damaged(c, bytes, size, "");
        bytes[i / 8] ^= (char)(1 << i % 8);
    }
}

/* Changes that a sum or a parity of the words would not detect: two words exchanged, the same bit
 * of two words changed, one word increased by what another is decreased. */
static void check_pairs(void *c, const char *bytes, size_t size)
{
    const size_t words = size / sizeof(uint64_t);
    _Alignas(uint64_t) char copy[4096];
    uint64_t *w = (void *)copy;
    memcpy(copy, bytes, size);
    for (size_t i = offsetof(struct fmi_snapshot, mode) / sizeof *w; i < words; i++) {
        for (size_t k = i + 1; k < words; k++) {
            const uint64_t a = w[i], b = w[k];
            const uint64_t to[][2] = { { b, a }, { a ^ 1u << 7, b ^ 1u << 7 }, { a + 1, b - 1 } };
            for (int n = a == b; n < 3; n++) {
                w[i] = to[n][0];
                w[k] = to[n][1];
                check_damaged(c, copy, size, "its bytes have changed");
            }
            w[i] = a;
            w[k] = b;
        }
    }
}

/* Bytes as another build would make them: one value changed, with the right hash. */
static void check_other(void *c, const char *bytes, size_t size, size_t at, char value,
                        const char *words)
{
    _Alignas(struct fmi_snapshot) char copy[4096];
    struct fmi_snapshot *other = (void *)copy;
    memcpy(copy, bytes, size);
    copy[at] = value;
    other->hash = fmi_hash(other);
    check_damaged(c, copy, size, words);
}

/* Only bytes that the FMU has written are a state; a refusal leaves the instance as it was. */
static void test_damaged_states(void)
{
    void *c = make_running(0.0, -1.0), *state = NULL;
    char bytes[4096], longer[4096] = { 0 };
    CHECK(call_step(c, 0.0, 1e-3) == 0 && call_get_state(c, &state) == 0);
    const size_t size = call_state_size(c, state);
    CHECK(size + 64 <= sizeof longer && call_serialize(c, state, bytes, size) == 0);
    check_bits(c, bytes, size);
    check_pairs(c, bytes, size);
    memcpy(longer, bytes, size);
    for (size_t n = 0; n <= size + 64; n++) {
        if (n != size) {
            check_damaged(c, longer, n, "bytes given");
        }
    }
    check_other(c, bytes, size, offsetof(struct fmi_snapshot, token) + 1, 'D', "not one of Dummy");
    check_other(c, bytes, size, offsetof(struct fmi_snapshot, version), '9',
                "not one of this version of Dummy, 1.0");
    check_other(c, bytes, size, offsetof(struct fmi_snapshot, whole), 1,
                "not one of this version of Dummy, 1.0");
    void *after = NULL;
    char now[4096];
    CHECK(call_get_state(c, &after) == 0 && call_serialize(c, after, now, size) == 0);
    CHECK(memcmp(now, bytes, size) == 0);
    CHECK(call_deserialize(c, bytes, size, &state) == 0);
    CHECK(call_set_state(c, state) == 0 && call_step(c, 1e-3, 1e-3) == 0);
    call_free_state(c, &after);
    call_free_state(c, &state);
    call_free(c);
}

/* A state whose blob cannot be made is refused, and the instance runs on as it was. */
static void test_state_with_another_blob(void)
{
    void *a = make(), *b = make_running(0.0, -1.0), *state = NULL;
    CHECK(call_set_name(a, "other") == 0 && call_set_name(a, "x") == 0);
    CHECK(call_enter(a, 0.0, -1.0) == 0 && call_exit(a) == 0);
    CHECK(call_get_state(a, &state) == 0);
    int before = opens;
    CHECK(call_set_state(b, state) == 0 && opens == before + 1);
    CHECK(strcmp(call_get_name(b), "x") == 0);
    ((struct fmi_snapshot *)state)->s.v.name[0] = 'o';
    CHECK_REFUSED(call_set_state(b, state), "does not open");
    CHECK(strcmp(call_get_name(b), "x") == 0 && call_step(b, 0.0, 1e-3) == 0);
    call_free_state(a, &state);
    call_free(a);
    call_free(b);
}

static void test_instantiate(void)
{
    said[0] = '\0';
    CHECK(!call_instantiate("one", "{other}", "") && strstr(said, "\"{other}\" is not that of"));
    CHECK(!call_instantiate(NULL, FMU_TOKEN, "") && strstr(said, "instanceName"));
    CHECK(!call_instantiate("", FMU_TOKEN, ""));
    CHECK(!call_instantiate("one", NULL, ""));
    static const char *const folders[][2] = {
        { "/a b", "/a b/" },
        { "/a/", "/a/" },
        { NULL, "" },
        { "", "" },
        { "http://host/a", "" },
        { "file:/a", "/a/" },
        { "file:///a%20b%2fc", "/a b/c/" },
        { "file://localhost/a/", "/a/" },
        { "file:///100%", "/100%/" },
        { "file:///%zz%4", "/%zz%4/" },
        { "/plain%20", "/plain%20/" },
    };
    for (size_t i = 0; i < sizeof folders / sizeof *folders; i++) {
        void *c = call_instantiate("one", FMU_TOKEN, folders[i][0]);
        CHECK(c && strcmp(fmu_resources(c), folders[i][1]) == 0);
        call_free(c);
    }
    call_free(NULL);
    CHECK(call_step(NULL, 0.0, 1e-3) == 3 && call_set_n(NULL, 1) == 3 && call_reset(NULL) == 3);
}

/* What a parameter names as a file: the path, or what is said of it. The folder is the root, so a
 * name that leads out of it would be found. */
static void test_paths(void)
{
    static const struct {
        const char *given, *text;
        bool good;
    } cases[] = {
        { "a/b.ngc", "a/b.ngc", true },
        { "FILE:///a%20b", "/a b", true },
        { "resource:dev/null", "/dev/null", true },
        { "resource:dev/../dev/null", "without \"..\"", false },
        { "resource:..", "without \"..\"", false },
        { "resource:/dev/null", "without \"..\"", false },
        { "resource:", "without \"..\"", false },
        { "resource:?", "no such file", false },
        { "resource:?/b", "no such file", false },
        { "resource:..?", "no such file", false },
        { "file://", "file:///PATH is wanted", false },
        { "file:///%00", "two hexadecimal digits", false },
        { "ftp://a/b", "resource:NAME is wanted", false },
    };
    void *c = call_instantiate("one", FMU_TOKEN, "/");
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        const struct fmu_path p = fmu_path(c, cases[i].given, FMU_READ);
        CHECK(p.good == cases[i].good);
        CHECK(cases[i].good ? !strcmp(p.text, cases[i].text) : !!strstr(p.text, cases[i].text));
    }
    CHECK(!fmu_path(c, "resource:dev/null", FMU_WRITTEN).good);
    call_free(c);
}

#include "fmi_any_step.h"
#include "fmi_small_state.h"

static int test_all(void)
{
    test_instantiate();
    test_paths();
    test_order_of_calls();
    test_messages_of_wrong_order();
    test_values_are_refused_whole();
    test_start_on_demand();
    test_a_start_finds_cleared_memory();
    test_steps();
    test_an_hour_of_added_doubles();
    test_any_step();
    test_logging();
    test_states();
    test_states_of_equal_values();
    test_state_with_another_tunable();
    test_small_states();
    test_the_last_step();
    test_damaged_states();
    test_state_with_another_blob();
    test_own();
    CHECK(blobs_open == 0);
    printf("%d failures\n", failures);
    return failures != 0;
}

#endif
