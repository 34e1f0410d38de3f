/* A master that runs one FMU and writes down what it computed, to the bit:
 *
 *     run LIBRARY GUID NANOSECONDS STEPS INPUTS READS OUT
 *
 * INPUTS and READS are lists of value references such as 1,2,5. In every step each input moves a little, all of them differently; every
 * 16th step, and after the last one, the values of READS go to OUT, eight bytes each. Half way the slave is saved, its state goes to
 * OUT too, and the next steps are done twice: once before and once after the saved state came back from its bytes. All numbers are made
 * of whole numbers by operations that IEEE 754 rounds correctly, so that two machines differ only where the FMU does. */
#include "../../importers/c/fmi2.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#ifdef _WIN32
#include <windows.h>
#define OPEN(path) ((void *)LoadLibraryA(path))
#define FIND(library, name) ((void *)GetProcAddress((HMODULE)(library), name))
#else
#include <dlfcn.h>
#define OPEN(path) dlopen(path, RTLD_NOW | RTLD_LOCAL)
#define FIND(library, name) dlsym(library, name)
#endif

enum { EVERY = 16, TWICE = 20, MOST = 1000 };

#define FIELD(result, name, arguments) result(*name) arguments;
static struct {
    FMI2_FUNCTIONS(FIELD)
} fmi2;

typedef struct {
    size_t count;
    fmi2ValueReference references[MOST];
    fmi2Real values[MOST];
} Variables;

static Variables inputs, reads;
static double step;

static void fail(const char *what)
{
    fprintf(stderr, "run: %s\n", what);
    exit(1);
}

static void check(const char *what, fmi2Status status)
{
    if (status != fmi2OK)
        fail(what);
}

static void logger(fmi2ComponentEnvironment environment, fmi2String instance, fmi2Status status, fmi2String category, fmi2String message,
                   ...)
{
    (void)environment, (void)instance, (void)category;
    if (status != fmi2OK)
        fprintf(stderr, "slave: %s\n", message);
}

static void load(const char *path)
{
    void *library = OPEN(path);
    if (!library)
        fail("the library does not load");
    void *function;
#define LOAD(result, name, arguments)             \
    if (!(function = FIND(library, "fmi2" #name))) \
        fail("fmi2" #name " is missing");         \
    memcpy(&fmi2.name, &function, sizeof function);
    FMI2_FUNCTIONS(LOAD)
}

static void list(Variables *variables, char *text)
{
    for (char *word = strtok(text, ","); word; word = strtok(NULL, ",")) {
        if (variables->count == MOST)
            fail("too many variables");
        variables->references[variables->count++] = (fmi2ValueReference)strtoul(word, NULL, 10);
    }
}

/* Micrometres, in a pattern of its own for each input. */
static void do_step(fmi2Component slave, long number)
{
    for (size_t input = 0; input < inputs.count; ++input) {
        long place = number * (long)(input + 1) % 64 - 32;
        inputs.values[input] = (double)place / 32.0 / 1e6;
    }
    check("SetReal", fmi2.SetReal(slave, inputs.references, inputs.count, inputs.values));
    check("DoStep", fmi2.DoStep(slave, (double)number * step, step, 0));
}

static void read_all(fmi2Component slave)
{
    check("GetReal", fmi2.GetReal(slave, reads.references, reads.count, reads.values));
}

static void write_all(FILE *out, const void *bytes, size_t size)
{
    if (fwrite(bytes, 1, size, out) != size)
        fail("the results cannot be written");
}

/* Saves the slave, goes on for some steps, and does them again from the bytes of its state. */
static void repeat_from_saved_state(fmi2Component slave, long number, FILE *out)
{
    fmi2FMUstate saved = NULL, restored = NULL;
    size_t size;
    check("GetFMUstate", fmi2.GetFMUstate(slave, &saved));
    check("SerializedFMUstateSize", fmi2.SerializedFMUstateSize(slave, saved, &size));
    fmi2Byte *bytes = malloc(size);
    if (!bytes)
        fail("no memory");
    check("SerializeFMUstate", fmi2.SerializeFMUstate(slave, saved, bytes, size));
    write_all(out, bytes, size);
    for (long next = number; next < number + TWICE; ++next)
        do_step(slave, next);
    read_all(slave);
    static fmi2Real once[MOST];
    memcpy(once, reads.values, sizeof once);
    check("DeSerializeFMUstate", fmi2.DeSerializeFMUstate(slave, bytes, size, &restored));
    check("SetFMUstate", fmi2.SetFMUstate(slave, restored));
    for (long next = number; next < number + TWICE; ++next)
        do_step(slave, next);
    read_all(slave);
    if (memcmp(once, reads.values, reads.count * sizeof *once))
        fail("a restored state does not continue as the slave did");
    check("SetFMUstate", fmi2.SetFMUstate(slave, restored));
    check("FreeFMUstate", fmi2.FreeFMUstate(slave, &saved));
    check("FreeFMUstate", fmi2.FreeFMUstate(slave, &restored));
    free(bytes);
}

int main(int count, char **arguments)
{
    if (count != 8)
        fail("run LIBRARY GUID NANOSECONDS STEPS INPUTS READS OUT");
    load(arguments[1]);
    step = (double)atol(arguments[3]) / 1e9;
    long steps = atol(arguments[4]);
    list(&inputs, arguments[5]);
    list(&reads, arguments[6]);
    FILE *out = fopen(arguments[7], "wb");
    if (!out)
        fail("the results cannot be written");

    fmi2CallbackFunctions callbacks = {logger, calloc, free, NULL, NULL};
    fmi2Component slave = fmi2.Instantiate("run", fmi2CoSimulation, arguments[2], "", &callbacks, 0, 0);
    if (!slave)
        fail("no instance");
    check("SetupExperiment", fmi2.SetupExperiment(slave, 0, 0.0, 0.0, 0, 0.0));
    check("EnterInitializationMode", fmi2.EnterInitializationMode(slave));
    check("ExitInitializationMode", fmi2.ExitInitializationMode(slave));
    for (long number = 0; number < steps; ++number) {
        if (number == steps / 2)
            repeat_from_saved_state(slave, number, out);
        do_step(slave, number);
        if (number % EVERY == 0 || number == steps - 1) {
            read_all(slave);
            write_all(out, reads.values, reads.count * sizeof *reads.values);
        }
    }
    check("Terminate", fmi2.Terminate(slave));
    fmi2.FreeInstance(slave);
    if (fclose(out))
        fail("the results cannot be written");
    return 0;
}
