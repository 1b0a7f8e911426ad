/* fmi_small_state - tests that saved states leave out what is not in use and restore the rest: for
 * every filling of a ring, empty, full and wrapped round. Included by fmi_cases.h. */
#ifndef FMI_SMALL_STATE_H
#define FMI_SMALL_STATE_H

/* Equal values give equal bytes: nothing remains of a longer string. */
static void test_states_of_equal_values(void)
{
    void *c[2] = { make(), make() }, *state[2] = { NULL, NULL };
    char bytes[2][4096];
    size_t size = 0;
    CHECK(call_set_name(c[1], "a much longer name than before") == 0);
    for (int i = 0; i < 2; i++) {
        CHECK(call_set_name(c[i], "x") == 0);
        CHECK(call_enter(c[i], 0.0, -1.0) == 0 && call_exit(c[i]) == 0);
        CHECK(call_get_state(c[i], &state[i]) == 0);
        size = call_state_size(c[i], state[i]);
        CHECK(size <= sizeof bytes[i] && call_serialize(c[i], state[i], bytes[i], size) == 0);
    }
    CHECK(memcmp(bytes[0], bytes[1], size) == 0);
    for (int i = 0; i < 2; i++) {
        call_free_state(c[i], &state[i]);
        call_free(c[i]);
    }
}

static struct model *model_of(void *c)
{
    return &((struct fmi_instance *)c)->f.s.m;
}

/* Elements of the ring in use get different numbers, the others arbitrary ones. */
static void fill(struct model *m, int32_t first, int32_t used, double number)
{
    m->first = first;
    m->used = used;
    for (int32_t i = 0; i < KEPT; i++) {
        m->kept[(first + i) % KEPT] = i < used ? number + i : -number;
    }
}

static void check_fill(void *a, void *b, int32_t first, int32_t used)
{
    const struct model *m = model_of(b);
    void *state = NULL, *copy = NULL;
    char bytes[4096];
    fill(model_of(a), first, used, 1000.0);
    fill(model_of(b), 17, 50, 5.0);
    CHECK(call_get_state(a, &state) == 0);
    const size_t size = call_state_size(a, state);
    const size_t whole = sizeof(struct fmi_snapshot);
    const size_t least = (size_t)used * sizeof m->kept[0];
    CHECK(size <= whole - sizeof m->kept + least + 2 * (sizeof(struct fmu_span) + FMU_SPAN_MIN));
    CHECK(call_serialize(a, state, bytes, size) == 0);
    CHECK(call_deserialize(b, bytes, size, &copy) == 0 && call_set_state(b, copy) == 0);
    bool same = m->first == first && m->used == used;
    for (int32_t i = 0; i < used; i++) {
        same = same && m->kept[(first + i) % KEPT] == 1000.0 + i;
    }
    CHECK(same);
    call_free_state(a, &state);
    call_free_state(b, &copy);
}

/* The same pointer may be used for states of different sizes, again and again. */
static void check_one_place(void *a, void *b)
{
    void *state = NULL;
    for (int32_t k = 0; k < 300; k++) {
        const int32_t used = k * 37 % (KEPT + 1);
        fill(model_of(a), k % KEPT, used, k);
        CHECK(call_get_state(a, &state) == 0 && call_set_state(b, state) == 0);
        CHECK(used == 0 || model_of(b)->kept[(k + used - 1) % KEPT] == k + used - 1);
    }
    call_free_state(a, &state);
}

static void test_small_states(void)
{
    void *a = make_running(0.0, -1.0), *b = make_running(0.0, -1.0);
    for (int32_t first = 0; first < KEPT; first += 3) {
        for (int32_t used = 0; used <= KEPT; used++) {
            check_fill(a, b, first, used);
        }
    }
    check_one_place(a, b);
    call_free(a);
    call_free(b);
    /* Before the start a state contains no model. */
    void *state = NULL;
    a = make();
    CHECK(call_get_state(a, &state) == 0);
    CHECK(call_state_size(a, state) < sizeof(struct fmi_snapshot) - sizeof(struct model) + 100);
    call_free_state(a, &state);
    call_free(a);
}

#endif
