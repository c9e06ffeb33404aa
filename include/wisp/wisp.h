/* Wisp for C, for other languages and for engines: load a model, keep living instances of it in a bank, give them wind,
 * let time pass, read what they do.
 *
 *     wisp_model* model = NULL;
 *     wisp_bank* bank = NULL;
 *     wisp_instance flame = WISP_NO_INSTANCE;
 *     if (wisp_model_load(bytes, size, &model) != WISP_OK) puts(wisp_last_error());
 *     wisp_bank_create(model, NULL, &bank);
 *     wisp_bank_spawn(bank, &flame);
 *     for (each frame) {
 *       wisp_bank_set_common_inputs(bank, &wind, 1);
 *       wisp_bank_advance(bank, nanoseconds_since_last_frame, NULL);
 *       wisp_bank_polyline(bank, flame, points, 2 * polyline_points);
 *     }
 *
 * C99; nothing here throws, ends the process, or keeps a pointer that it was given, other than a bank's memory.
 *
 * Outcome. Functions that can fail return a wisp_status; what was wrong is in wisp_last_error(). A function that fails
 * changes nothing. A null handle or pointer, and a count that is not the stated one, are WISP_BAD_ARGUMENT.
 *
 * Frames. What is documented under "the frame path" allocates nothing, takes no lock and makes no system call, and
 * gives the same bits on every machine; docs/architecture.md has the promises.
 *
 * Threads. Handles may be used from any thread, each by one thread at a time. A model is not changed by use and may
 * serve many threads at once.
 *
 * Versions. Functions stay as they are once released. Structs begin with their own size, which the caller sets to
 * sizeof: fields are only ever added at the end, and what a caller does not know has its default. */

#ifndef WISP_WISP_H
#define WISP_WISP_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#define WISP_VERSION_MAJOR 0
#define WISP_VERSION_MINOR 1
#define WISP_VERSION_PATCH 0

/* The version of the library that is linked: major * 1000000 + minor * 1000 + patch. */
int32_t wisp_version(void);

typedef int32_t wisp_status;
enum {
  WISP_OK = 0,
  WISP_BAD_ARGUMENT = 1,     /* misuse: a null pointer, a wrong count, an option out of range */
  WISP_BAD_DATA = 2,         /* bytes from outside that are not what they should be */
  WISP_NO_INSTANCE_LEFT = 3, /* the bank is full */
  WISP_NOT_ALIVE = 4,        /* the instance has ended, or never was */
  WISP_NO_MEMORY = 5
};

/* One sentence about the last failure on this thread; "" before the first. Valid until the next failure on it. */
const char* wisp_last_error(void);

/* ---- Models ---- */

typedef struct wisp_model wisp_model;

/* Reads a model from the bytes of a .wisp file; they are not needed afterwards. Sets *model.
 * Fails with WISP_BAD_DATA when they are not a whole, sound model of a known version. */
wisp_status wisp_model_load(const void* bytes, size_t size, wisp_model** model);

/* Frees a model; banks made from it live on. NULL is fine. */
void wisp_model_free(wisp_model* model);

typedef struct wisp_model_facts {
  uint32_t size;           /* sizeof(wisp_model_facts), set by the caller */
  uint32_t inputs;         /* external inputs, before signs are split */
  uint32_t outputs;        /* for an outline: 2 * control_points, x and y in turn */
  uint32_t control_points; /* 0 where the outputs are not an outline */
  uint32_t usable;         /* 1 when learning found the model fit for use */
  uint32_t reserved;
  double rate_hz;         /* its own steps a second */
  double metres_per_unit; /* of an outline; 0 where it is not known */
  int64_t step_nanoseconds;
  int64_t multiply_adds_per_frame; /* by the paper's count: coefficients that are not zero */
  int64_t operations_per_frame;    /* all arithmetic, noise and a polyline of 32 points included */
  double blow_out_level;   /* wind of this strength blows an instance out, in the unit of its input; 0: nothing does, */
  double blow_out_seconds; /* when it lasts so long; stronger wind takes less */
} wisp_model_facts;

/* Fills the fields that the caller's `size` has room for. */
wisp_status wisp_model_get_facts(const wisp_model* model, wisp_model_facts* facts);

typedef struct wisp_channel {
  uint32_t size; /* sizeof(wisp_channel), set by the caller */
  uint32_t reserved;
  const char* name; /* these two live as long as the model */
  const char* unit;
  double lowest; /* the trained or seen range; held to it and half of it more */
  double highest;
} wisp_channel;

/* What input or output number `index`, from 0, is. */
wisp_status wisp_model_get_input(const wisp_model* model, uint32_t index, wisp_channel* channel);
wisp_status wisp_model_get_output(const wisp_model* model, uint32_t index, wisp_channel* channel);

/* The model's name; lives as long as the model. "" for NULL. */
const char* wisp_model_name(const wisp_model* model);

/* ---- Banks: living instances of one model, stepped together ---- */

typedef struct wisp_bank wisp_bank;

/* Names an instance by value: slot in the lower 32 bits, generation in the upper. Ended ones are never named again. */
typedef uint64_t wisp_instance;
#define WISP_NO_INSTANCE ((wisp_instance)0)

typedef struct wisp_bank_options {
  uint32_t size;            /* sizeof(wisp_bank_options), set by the caller */
  uint32_t capacity;        /* most instances alive at once, 1 to 1048576; 0: 1 */
  uint32_t polyline_points; /* 2 to 4096; 0: 32 */
  uint32_t reserved;        /* 0 */
  uint64_t seed;            /* of all random streams of the bank; as it is, 0 too */
  void* memory;             /* where the bank lives; NULL: it allocates once, when it is made */
  size_t memory_size;       /* at least wisp_bank_bytes() */
} wisp_bank_options;

/* Options with every default: capacity 1, 32 points, seed 1, memory of its own. */
wisp_bank_options wisp_bank_default_options(void);

/* How much memory a bank needs. `options` may be NULL for the defaults, here and below. */
wisp_status wisp_bank_bytes(const wisp_model* model, const wisp_bank_options* options, size_t* bytes);

/* Makes an empty bank; memory that the caller gives must outlive it. Sets *bank. */
wisp_status wisp_bank_create(const wisp_model* model, const wisp_bank_options* options, wisp_bank** bank);

/* Frees a bank. NULL is fine. */
void wisp_bank_free(wisp_bank* bank);

typedef struct wisp_bank_facts {
  uint32_t size; /* sizeof(wisp_bank_facts), set by the caller */
  uint32_t capacity;
  uint32_t alive; /* instances */
  uint32_t slots; /* rows of every bulk buffer: one more than the highest slot in use */
  uint32_t inputs;
  uint32_t outputs;
  uint32_t polyline_points; /* 0 where the outputs are not an outline */
  uint32_t reserved;
  uint64_t held;  /* steps of instances in which an output was held at its range, */
  uint64_t steps; /* of so many; more than 1 in 1000 on ordinary input: the model is not usable */
} wisp_bank_facts;

/* From here to wisp_bank_restore() is the frame path.
 *
 * Bulk buffers have one row per slot. Rows of empty slots are ignored on the way in and are zeros on the way out. */

wisp_status wisp_bank_get_facts(const wisp_bank* bank, wisp_bank_facts* facts);

/* Starts an instance at the model's operating point, with all inputs zero. Its random stream is the count of spawns so
 * far, or `stream`: two instances of the same stream and inputs live the same life. Sets *instance. */
wisp_status wisp_bank_spawn(wisp_bank* bank, wisp_instance* instance);
wisp_status wisp_bank_spawn_stream(wisp_bank* bank, uint64_t stream, wisp_instance* instance);

wisp_status wisp_bank_end(wisp_bank* bank, wisp_instance instance);

/* 1 when it lives in this bank, else 0. */
int32_t wisp_bank_alive(const wisp_bank* bank, wisp_instance instance);

/* The instance in a slot; WISP_NO_INSTANCE when it is empty. */
wisp_instance wisp_bank_at(const wisp_bank* bank, uint32_t slot);

/* What acts from the next step on, in the inputs' units: on all (slots * inputs), the same on all (inputs), on one
 * (inputs). What is not a number counts as 0; what is beyond the trained range and half of it is held there. */
wisp_status wisp_bank_set_inputs(wisp_bank* bank, const float* values, size_t count);
wisp_status wisp_bank_set_common_inputs(wisp_bank* bank, const float* values, size_t count);
wisp_status wisp_bank_set_instance_inputs(wisp_bank* bank, wisp_instance instance, const float* values, size_t count);

/* Scale of the residual noise: 1 as learned, 0 none; held to 0 to 10. */
wisp_status wisp_bank_set_noise(wisp_bank* bank, float scale);

/* One step of the model, whatever the time. */
wisp_status wisp_bank_step(wisp_bank* bank);

/* Lets time pass and shows what lies between the last two steps, one step late. Negative time counts as none, more than
 * ten seconds as ten. Sets *steps, unless NULL, to the steps made. */
wisp_status wisp_bank_advance(wisp_bank* bank, int64_t nanoseconds, int32_t* steps);

/* Outputs, in their units: of all (slots * outputs), of one (outputs). */
wisp_status wisp_bank_outputs(const wisp_bank* bank, float* values, size_t count);
wisp_status wisp_bank_instance_outputs(const wisp_bank* bank, wisp_instance instance, float* values, size_t count);

/* Outlines as points, x and y in turn, from the base's left over the tip to the base's right: of all
 * (slots * polyline_points * 2), of one (polyline_points * 2). */
wisp_status wisp_bank_polylines(const wisp_bank* bank, float* values, size_t count);
wisp_status wisp_bank_polyline(const wisp_bank* bank, wisp_instance instance, float* values, size_t count);

/* Whether an instance burns. Those of a model with a blow_out_level go out when the wind is too strong for too long,
 * and stay out whatever the wind does then. Outputs and outlines shrink to 0 by themselves; for smoke and ember there
 * is the time since, in nanoseconds of what is shown, or WISP_NEVER. */
#define WISP_NEVER INT64_MAX
typedef struct wisp_flame_state {
  uint32_t size;    /* sizeof(wisp_flame_state), set by the caller */
  uint32_t lit;     /* 1 or 0 */
  float flame_size; /* 0 to 1: what outputs are already multiplied by */
  uint32_t reserved;
  int64_t since_lit; /* since it was last lit again; one that was spawned lit was not */
  int64_t since_out; /* since it last went out */
} wisp_flame_state;

wisp_status wisp_bank_get_flame_state(const wisp_bank* bank, wisp_instance instance, wisp_flame_state* state);

/* The flame_size of all: slots. */
wisp_status wisp_bank_flame_sizes(const wisp_bank* bank, float* values, size_t count);

/* Lights an instance that is out: it starts from rest and grows. Puts one out, whatever the wind; where the model never
 * goes out nothing happens. Either does nothing to one that is so already. */
wisp_status wisp_bank_relight(wisp_bank* bank, wisp_instance instance);
wisp_status wisp_bank_extinguish(wisp_bank* bank, wisp_instance instance);

/* Back to where they were when spawned, lit: one, or all and the bank's time. */
wisp_status wisp_bank_reset_instance(wisp_bank* bank, wisp_instance instance);
wisp_status wisp_bank_reset(wisp_bank* bank);

/* The whole state as bytes, and back: a bank restored goes on with the same bits. The same model and capacity are
 * needed. Restoring fails with WISP_BAD_DATA when the bytes are damaged or of another model, capacity or version. */
wisp_status wisp_bank_save_bytes(const wisp_bank* bank, size_t* bytes);
wisp_status wisp_bank_save(const wisp_bank* bank, void* bytes, size_t size);
wisp_status wisp_bank_restore(wisp_bank* bank, const void* bytes, size_t size);

#ifdef __cplusplus
}
#endif

#endif
