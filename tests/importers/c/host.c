/* A master that does everything wrong: any function in any state, with arguments that are good, unknown, not finite or NULL.
 *
 *     host LIBRARY GUID INSTANCES SEED INPUT OUTPUT PARAMETER        (the last three: value references)
 *
 * Ends with 0 when the slave answered every call as FMI allows. Memory is the business of what watches this program: an address
 * sanitizer or valgrind. Two things it does itself: every array and string ends at a page that may not be touched, and is gone
 * after the call. */
#define _GNU_SOURCE
#include "fmi2.h"

#include <dlfcn.h>
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <unistd.h>

#define LENGTH(array) (sizeof(array) / sizeof(array)[0])
#define PICK(array) ((array)[below(LENGTH(array))])

enum { ALIVE = 4, CALLS = 40, STATES = 3, LONGEST = 3 };

#define FIELD(result, name, arguments) result(*name) arguments;
static struct {
    FMI2_FUNCTIONS(FIELD)
} fmi2;

typedef struct {
    fmi2Component component;
    char name[16];
    fmi2FMUstate states[STATES];
} Slave;

static Slave slaves[ALIVE];
static const char *guid;
static fmi2ValueReference references[4]; /* input, output, parameter, unknown */
static long calls, errors;

static void fail(const char *what, long value)
{
    fprintf(stderr, "host: %s (%ld) after %ld calls\n", what, value, calls);
    exit(1);
}

/* ---- chance: the same for the same seed */

static uint64_t chance;

static size_t below(size_t bound)
{
    chance ^= chance << 13;
    chance ^= chance >> 7;
    chance ^= chance << 17;
    return (size_t)(chance >> 11) % bound;
}

/* ---- memory that ends where a page begins that nobody may touch */

static struct {
    void *start;
    size_t size;
} lent[16];
static size_t lent_count;

static void *lend(const void *bytes, size_t size)
{
    size_t page = (size_t)sysconf(_SC_PAGESIZE), pages = (size + page - 1) / page;
    char *start = mmap(NULL, (pages + 1) * page, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    if (start == MAP_FAILED || lent_count == LENGTH(lent) || mprotect(start + pages * page, page, PROT_NONE) != 0)
        fail("no memory to lend", (long)size);
    lent[lent_count].start = start;
    lent[lent_count++].size = (pages + 1) * page;
    char *place = start + pages * page - size;
    if (size)
        memcpy(place, bytes, size);
    return place;
}

static void take_back(void)
{
    while (lent_count) {
        lent_count--;
        munmap(lent[lent_count].start, lent[lent_count].size);
    }
}

static void *lend_or_null(const void *bytes, size_t size)
{
    return below(8) ? lend(bytes, size) : NULL;
}

static const char *lend_text(const char *text)
{
    return lend(text, strlen(text) + 1);
}

/* ---- arguments */

static size_t count(void) { return below(LONGEST + 1); }

static fmi2ValueReference *some_references(size_t n)
{
    fmi2ValueReference chosen[LONGEST];
    for (size_t i = 0; i < n; i++)
        chosen[i] = below(4) ? references[below(3)] : PICK(references);
    return lend_or_null(chosen, n * sizeof chosen[0]);
}

static double number(void)
{
    const double numbers[] = {0.0, -0.0, 1e-6, -1.0, 1e-4, 1e300, -1e-300, INFINITY, NAN};
    return PICK(numbers);
}

static fmi2Real *some_reals(size_t n)
{
    fmi2Real chosen[LONGEST];
    for (size_t i = 0; i < n; i++)
        chosen[i] = number();
    return lend_or_null(chosen, n * sizeof chosen[0]);
}

static fmi2Integer *some_integers(size_t n)
{
    const fmi2Integer integers[] = {1, 1, 1, 0, -1, 2, 1000};
    fmi2Integer chosen[LONGEST];
    for (size_t i = 0; i < n; i++)
        chosen[i] = PICK(integers);
    return lend_or_null(chosen, n * sizeof chosen[0]);
}

static fmi2String *some_texts(size_t n)
{
    const char *const texts[] = {"logAll", "", "logStatusError", "no such category", NULL};
    fmi2String chosen[LONGEST];
    for (size_t i = 0; i < n; i++) {
        chosen[i] = PICK(texts);
        if (chosen[i])
            chosen[i] = lend_text(chosen[i]);
    }
    return lend_or_null(chosen, n * sizeof chosen[0]);
}

/* ---- what the slave says */

static void logger(fmi2ComponentEnvironment environment, fmi2String instance, fmi2Status status, fmi2String category,
                   fmi2String message, ...)
{
    const Slave *slave = environment;
    if (slave < slaves || slave >= slaves + ALIVE)
        fail("a component environment that is not ours", status);
    if (!instance || strcmp(instance, slave->name) != 0)
        fail("the name of another instance", status);
    if (!category || !*category || !message || !*message)
        fail("a message without category or text", status);
    if (strstr(message, "internal error"))
        fail(message, status);
}

static void check(fmi2Status status)
{
    calls++;
    errors += status == fmi2Error;
    if (status != fmi2OK && status != fmi2Error && status != fmi2Discard)
        fail("a status that no call of ours may have", status);
    take_back();
}

/* ---- life and death */

static void instantiate(Slave *slave)
{
    static unsigned born;
    memset(slave, 0, sizeof *slave);
    snprintf(slave->name, sizeof slave->name, "slave%u", ++born);
    fmi2CallbackFunctions callbacks = {logger, NULL, NULL, NULL, slave};
    const char *const resources[] = {"file:///tmp/resources", "", "no URI", NULL};
    const char *resource = PICK(resources);
    slave->component = fmi2.Instantiate(lend_text(slave->name), fmi2CoSimulation, lend_text(guid), resource ? lend_text(resource) : NULL,
                                        lend(&callbacks, sizeof callbacks), (int)below(2), (int)below(2));
    if (!slave->component)
        fail("no instance", born);
    take_back();
}

/* Arguments with which nothing can be born. */
static void stillbirths(void)
{
    fmi2CallbackFunctions callbacks = {logger, NULL, NULL, NULL, &slaves[0]}, silent = {NULL, NULL, NULL, NULL, NULL};
    snprintf(slaves[0].name, sizeof slaves[0].name, "unborn");
    if (fmi2.Instantiate("unborn", fmi2CoSimulation, guid, NULL, NULL, 0, 0) ||
        fmi2.Instantiate("unborn", fmi2CoSimulation, "another", NULL, &callbacks, 0, 1) ||
        fmi2.Instantiate("unborn", fmi2CoSimulation, NULL, NULL, &callbacks, 0, 1) ||
        fmi2.Instantiate("unborn", fmi2ModelExchange, guid, NULL, &callbacks, 0, 1) ||
        fmi2.Instantiate(NULL, fmi2CoSimulation, guid, NULL, &silent, 0, 1) ||
        fmi2.Instantiate(NULL, fmi2CoSimulation, NULL, NULL, &silent, 0, 1))
        fail("an instance that must not be", 0);
}

static void bury(Slave *slave)
{
    for (size_t i = 0; i < STATES; i++)
        check(fmi2.FreeFMUstate(slave->component, &slave->states[i]));
    fmi2.FreeInstance(slave->component);
    slave->component = NULL;
}

/* ---- one call of each kind */

static double present(fmi2Component c)
{
    double time = 0.0;
    fmi2.GetRealStatus(c, fmi2LastSuccessfulTime, &time); /* refused before step mode */
    return time;
}

static void step(fmi2Component c)
{
    const double steps[] = {2e-5, 2e-5, 2e-5, 1e-16, 5e-324, 1e-4, 0.0, -1e-5, NAN, INFINITY, 1e300};
    double time = below(8) ? present(c) : number();
    fmi2Status status = fmi2.DoStep(c, time, PICK(steps), (int)below(3));
    if (status == fmi2Discard)
        fail("a step that was discarded", 0);
    check(status);
}

static void serialize(fmi2Component c, fmi2FMUstate *state, fmi2FMUstate *other)
{
    size_t size = 0;
    check(fmi2.SerializedFMUstateSize(c, *state, below(8) ? &size : NULL));
    if (size > 10000000)
        fail("a state too large", (long)size);
    char *bytes = calloc(size + 1, 1);
    size_t room = below(4) ? size : below(size + 1);
    char *written = lend(bytes, room);
    fmi2Status status = fmi2.SerializeFMUstate(c, *state, below(8) ? written : NULL, room);
    memcpy(bytes, written, room);
    check(status);
    if (size && !below(4))
        bytes[below(size)] ^= (char)(1 << below(8));
    check(fmi2.DeSerializeFMUstate(c, lend_or_null(bytes, room), room, below(8) ? other : NULL));
    free(bytes);
}

static void derivatives(fmi2Component c, size_t kind)
{
    size_t n = count(), m = count();
    fmi2ValueReference *known = some_references(n), *unknown = some_references(m);
    if (kind == 0)
        check(fmi2.GetDirectionalDerivative(c, unknown, m, known, n, some_reals(n), some_reals(m)));
    else if (kind == 1)
        check(fmi2.SetRealInputDerivatives(c, known, n, some_integers(n), some_reals(n)));
    else
        check(fmi2.GetRealOutputDerivatives(c, unknown, m, some_integers(m), some_reals(m)));
}

static void status(fmi2Component c)
{
    fmi2StatusKind kind = (fmi2StatusKind)below(6);
    fmi2Real real = 0;
    fmi2Integer integer = 0;
    fmi2String text = NULL;
    fmi2Status answer = fmi2OK;
    check(fmi2.GetStatus(c, kind, lend_or_null(&answer, sizeof answer)));
    check(fmi2.GetRealStatus(c, kind, lend_or_null(&real, sizeof real)));
    check(fmi2.GetIntegerStatus(c, kind, lend_or_null(&integer, sizeof integer)));
    check(fmi2.GetBooleanStatus(c, kind, lend_or_null(&integer, sizeof integer)));
    check(fmi2.GetStringStatus(c, kind, lend_or_null(&text, sizeof text)));
}

static void variables(fmi2Component c, size_t kind)
{
    size_t n = count();
    fmi2ValueReference *chosen = some_references(n);
    switch (kind) {
    case 0: check(fmi2.GetReal(c, chosen, n, some_reals(n))); break;
    case 1: check(fmi2.SetReal(c, chosen, n, some_reals(n))); break;
    case 2: check(fmi2.GetInteger(c, chosen, n, some_integers(n))); break;
    case 3: check(fmi2.SetInteger(c, chosen, n, some_integers(n))); break;
    case 4: check(fmi2.GetBoolean(c, chosen, n, some_integers(n))); break;
    case 5: check(fmi2.SetBoolean(c, chosen, n, some_integers(n))); break;
    case 6: check(fmi2.GetString(c, chosen, n, some_texts(n))); break;
    default: check(fmi2.SetString(c, chosen, n, some_texts(n))); break;
    }
}

static void setup(fmi2Component c)
{
    int good = below(4) != 0;
    check(fmi2.SetupExperiment(c, !good, number(), good ? 0.0 : number(), !good, number()));
}

static void anything(fmi2Component c, fmi2FMUstate *states)
{
    fmi2FMUstate *state = &states[below(STATES)], *other = &states[below(STATES)];
    size_t n = count();
    switch (below(20)) {
    case 0: check(fmi2.SetDebugLogging(c, (int)below(2), n, some_texts(n))); break;
    case 1: setup(c); break;
    case 2: check(fmi2.EnterInitializationMode(c)); break;
    case 3: check(fmi2.ExitInitializationMode(c)); break;
    case 4: below(4) ? step(c) : check(fmi2.Terminate(c)); break;
    case 5: below(4) ? step(c) : check(fmi2.Reset(c)); break;
    case 6: variables(c, below(8)); break;
    case 7: variables(c, below(2)); break;
    case 8: check(fmi2.GetFMUstate(c, below(8) ? state : NULL)); break;
    case 9: check(fmi2.SetFMUstate(c, *state)); break;
    case 10: check(fmi2.FreeFMUstate(c, below(8) ? state : NULL)); break;
    case 11: serialize(c, state, other); break;
    case 12: derivatives(c, 0); break;
    case 13: derivatives(c, 1); break;
    case 14: derivatives(c, 2); break;
    case 15: check(fmi2.CancelStep(c)); break;
    case 16: status(c); break;
    default: step(c); break;
    }
}

/* In step mode, so that not all luck is needed to get there. */
static void initialize(fmi2Component c)
{
    check(fmi2.SetupExperiment(c, 0, 0.0, 0.0, 0, 0.0));
    check(fmi2.EnterInitializationMode(c));
    check(fmi2.ExitInitializationMode(c));
}

static void nobody(void)
{
    fmi2FMUstate none[STATES] = {NULL};
    long before = calls, refused = errors;
    for (size_t i = 0; i < 2000; i++)
        anything(NULL, none);
    fmi2.FreeInstance(NULL);
    if (calls - before != errors - refused)
        fail("NULL as component was not refused", calls - before - errors + refused);
}

static void *load(const char *path)
{
    void *library = dlopen(path, RTLD_NOW | RTLD_LOCAL);
    if (!library)
        fail(dlerror(), 0);
#define LOOK_UP(result, name, arguments)                                                                                         \
    if (!(*(void **)&fmi2.name = dlsym(library, "fmi2" #name)))                                                                  \
        fail("no function fmi2" #name, 0);
    FMI2_FUNCTIONS(LOOK_UP)
    return library;
}

int main(int argc, char **argv)
{
    if (argc != 8)
        fail("arguments", argc);
    void *library = load(argv[1]);
    guid = argv[2];
    long instances = atol(argv[3]);
    chance = strtoull(argv[4], NULL, 10) * 2 + 1;
    for (size_t i = 0; i < 3; i++)
        references[i] = (fmi2ValueReference)strtoul(argv[5 + i], NULL, 10);
    references[3] = UINT32_MAX;
    if (strcmp(fmi2.GetVersion(), "2.0") != 0 || strcmp(fmi2.GetTypesPlatform(), "default") != 0)
        fail("version or platform", 0);
    stillbirths();
    nobody();
    for (long i = 0; i < instances; i++) {
        Slave *slave = &slaves[below(ALIVE)];
        if (slave->component)
            bury(slave);
        instantiate(slave);
        if (below(2))
            initialize(slave->component);
        for (size_t j = 0; j < CALLS; j++) {
            Slave *any = &PICK(slaves);
            if (any->component)
                anything(any->component, any->states);
        }
    }
    for (size_t i = 0; i < ALIVE; i++)
        if (slaves[i].component)
            bury(&slaves[i]);
    printf("%ld instances, %ld calls, %ld refused\n", instances, calls, errors);
    return dlclose(library);
}
