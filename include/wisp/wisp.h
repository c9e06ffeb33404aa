/* Wisp for C, for other languages and for engines: load a model, create a bank of its instances, set the wind, advance
 * time, read the outputs.
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
 * C99; no function throws, ends the process, or keeps a pointer passed to it, other than a bank's memory and its crew.
 *
 * Errors. Functions that can fail return a wisp_status; wisp_last_error() describes the failure. A function that fails
 * changes nothing. A null handle or pointer, and a count that is not the stated one, are WISP_BAD_ARGUMENT.
 *
 * Frames. Functions documented under "the frame path" allocate nothing, take no lock and make no system call, and give
 * the same bits on every machine; docs/architecture.md has the promises.
 *
 * Threads. Handles may be used from any thread, each by one thread at a time. A model is not changed by use and may
 * serve many threads at once.
 *
 * Versions. Functions stay unchanged once released. Structs begin with their own size, which the caller sets to sizeof:
 * fields are only ever added at the end, and fields unknown to the caller have their defaults. */

#ifndef WISP_WISP_H
#define WISP_WISP_H

#include <stddef.h>
#include <stdint.h>

/* Symbols exported by the library. Programs that link the shared one on Windows define WISP_SHARED. */
#if defined(_WIN32) && defined(WISP_EXPORTS)
#define WISP_API __declspec(dllexport)
#elif defined(_WIN32) && defined(WISP_SHARED)
#define WISP_API __declspec(dllimport)
#elif defined(__GNUC__) && !defined(_WIN32)
#define WISP_API __attribute__((visibility("default")))
#else
#define WISP_API
#endif

#ifdef __cplusplus
extern "C" {
#endif

#define WISP_VERSION_MAJOR 0
#define WISP_VERSION_MINOR 1
#define WISP_VERSION_PATCH 0

/* Returns the version of the linked library: major * 1000000 + minor * 1000 + patch. */
WISP_API int32_t wisp_version(void);

typedef int32_t wisp_status;
enum {
  WISP_OK = 0,
  WISP_BAD_ARGUMENT = 1,     /* misuse: a null pointer, a wrong count, an option out of range */
  WISP_BAD_DATA = 2,         /* invalid bytes or data from outside */
  WISP_NO_INSTANCE_LEFT = 3, /* the bank is full */
  WISP_NOT_ALIVE = 4,        /* the instance has ended, or never was */
  WISP_NO_MEMORY = 5,
  WISP_STOPPED = 6 /* a wisp_progress callback returned 0 */
};

/* Returns one sentence about this thread's last failure; "" before the first. Valid until its next failure. */
WISP_API const char* wisp_last_error(void);

/* ---- Models ---- */

typedef struct wisp_model wisp_model;

/* Reads a model from the bytes of a .wisp file, which are not needed afterwards. Sets *model.
 * Fails with WISP_BAD_DATA if the bytes are not a complete, valid model of a known version. */
WISP_API wisp_status wisp_model_load(const void* bytes, size_t size, wisp_model** model);

/* Frees a model; banks made from the model stay valid. NULL is allowed. */
WISP_API void wisp_model_free(wisp_model* model);

/* Creates the three-dimensional body of a flame, by rotational symmetry, as a separate model. Its wind is two inputs: x
 * to the right of the camera that filmed the flame, z towards the camera. WISP_BAD_ARGUMENT if that is impossible. */
WISP_API wisp_status wisp_model_in_the_round(const wisp_model* model, wisp_model** round);

/* Dynamics of the outputs. */
enum {
  WISP_DYNAMICS_ARX = 1,     /* autoregression with exogenous inputs */
  WISP_DYNAMICS_CHAIN = 2,   /* recorded segments of motion, joined at random */
  WISP_DYNAMICS_SWITCHED = 3 /* several ARX models, one active at a time */
};

/* Meaning of the outputs. */
enum {
  WISP_VIEW_PLAIN = 0,   /* no further meaning */
  WISP_VIEW_OUTLINE = 1, /* control points x, y of an outline: x right, y up, mean height 1 */
  WISP_VIEW_POSE = 2,    /* position x, y, z in metres, z up; unit quaternion w, x, y, z, body to world */
  WISP_VIEW_POSITION = 3 /* position x, y, z in metres, z up */
};

typedef struct wisp_model_facts {
  uint32_t size;           /* sizeof(wisp_model_facts), set by the caller */
  uint32_t inputs;         /* number of external inputs; one input makes one regressor or more */
  uint32_t outputs;        /* number of outputs; for an outline 2 * control_points, x and y alternating */
  uint32_t control_points; /* 0 if the outputs are not an outline */
  uint32_t usable;         /* 1 if learning found the model fit for use */
  uint32_t reserved;
  double rate_hz;         /* the model's steps per second */
  double metres_per_unit; /* of an outline; 0: unknown */
  int64_t step_nanoseconds;
  int64_t multiply_adds_per_frame; /* number of nonzero coefficients, the count of Reissell and Pai (2001) */
  int64_t operations_per_frame;    /* all arithmetic, including noise and a polyline of 32 points. Both counts are as
                                      stored in the file; 0: not stored */
  double blow_out_level;   /* least wind that blows an instance out, in the unit of its input; 0: no wind does */
  double blow_out_seconds; /* duration until the flame is out at that wind; stronger wind takes less */
  uint32_t dynamics;       /* one of WISP_DYNAMICS_* */
  uint32_t view;           /* WISP_VIEW_PLAIN, WISP_VIEW_OUTLINE, WISP_VIEW_POSE or WISP_VIEW_POSITION */
  double half_width;       /* metres from a body's middle to its edge on its first axis, a leaf's midrib; 0: unknown */
  double half_length;      /* the same on its second axis; 0: unknown, or WISP_VIEW_POSITION */
  double blow_out_haste;   /* the duration at twice the level is blow_out_seconds / (1 + blow_out_haste) */
  double blow_out_recovery_seconds; /* time below the level until full recovery */
  uint32_t blow_out_input;          /* index of the input that blows instances out */
  uint32_t reserved_2;
} wisp_model_facts;

/* Fills those fields that fit in the caller's `size`. */
WISP_API wisp_status wisp_model_get_facts(const wisp_model* model, wisp_model_facts* facts);

typedef struct wisp_channel {
  uint32_t size; /* sizeof(wisp_channel), set by the caller */
  uint32_t reserved;
  const char* name; /* name and unit live as long as the model */
  const char* unit;
  double lowest;     /* range in training */
  double highest;    /* inputs, and outputs except a chain's, are clamped to that range extended by half its width */
  uint32_t even_odd; /* 1 if an input enters by regressors that are even and odd functions of the input */
  uint32_t reserved2;
} wisp_channel;

/* Describes input or output number `index`, from 0. */
WISP_API wisp_status wisp_model_get_input(const wisp_model* model, uint32_t index, wisp_channel* channel);
WISP_API wisp_status wisp_model_get_output(const wisp_model* model, uint32_t index, wisp_channel* channel);

/* Returns the model's name, which lives as long as the model; "" for NULL. */
WISP_API const char* wisp_model_name(const wisp_model* model);

/* ---- Record of a model's making. Texts live as long as the model. ---- */

typedef struct wisp_provenance {
  uint32_t size;    /* sizeof(wisp_provenance), set by the caller */
  uint32_t sources; /* numbers of source recordings, options and figures */
  uint32_t options;
  uint32_t figures;
  uint32_t usable; /* 1 if learning found the model fit for use */
  uint32_t reserved;
  const char* program; /* name and version of the program that wrote the model */
  const char* reason;  /* reason why the model is fit for use, or not */
} wisp_provenance;

/* A named fact: an option given to the learner. */
typedef struct wisp_note {
  uint32_t size; /* sizeof(wisp_note), set by the caller */
  uint32_t reserved;
  const char* name;
  const char* value;
} wisp_note;

/* A named figure of the model's quality. */
typedef struct wisp_figure {
  uint32_t size; /* sizeof(wisp_figure), set by the caller */
  uint32_t reserved;
  const char* name;
  double value;
} wisp_figure;

WISP_API wisp_status wisp_model_get_provenance(const wisp_model* model, wisp_provenance* provenance);

/* Return item `index`, from 0, of each list. The first sets *name to the file name of a recording used for learning. */
WISP_API wisp_status wisp_model_get_source(const wisp_model* model, uint32_t index, const char** name);
WISP_API wisp_status wisp_model_get_option(const wisp_model* model, uint32_t index, wisp_note* option);
WISP_API wisp_status wisp_model_get_figure(const wisp_model* model, uint32_t index, wisp_figure* figure);

/* Facts of a model whose dynamics are WISP_DYNAMICS_ARX; others are a WISP_BAD_ARGUMENT. */
typedef struct wisp_arx_facts {
  uint32_t size;       /* sizeof(wisp_arx_facts), set by the caller */
  uint32_t outputs;    /* rows of the matrices of orders */
  uint32_t regressors; /* number of inputs of the dynamics */
  uint32_t history;    /* largest lag, steps */
  uint32_t resamples;  /* 1 if recorded residuals are replayed, 0 if the noise is Gaussian */
} wisp_arx_facts;

WISP_API wisp_status wisp_model_get_arx(const wisp_model* model, wisp_arx_facts* facts);

/* Read matrices of orders, row by row: na (outputs * outputs), nb and nk (outputs * regressors). */
WISP_API wisp_status wisp_model_arx_na(const wisp_model* model, int32_t* values, size_t count);
WISP_API wisp_status wisp_model_arx_nb(const wisp_model* model, int32_t* values, size_t count);
WISP_API wisp_status wisp_model_arx_nk(const wisp_model* model, int32_t* values, size_t count);

/* Reads the standard deviation of the noise per output of the dynamics, in its unit: wisp_arx_facts.outputs values. */
WISP_API wisp_status wisp_model_arx_noise(const wisp_model* model, double* values, size_t count);

/* Facts of a model whose dynamics are WISP_DYNAMICS_CHAIN; others are a WISP_BAD_ARGUMENT. */
typedef struct wisp_chain_facts {
  uint32_t size;         /* sizeof(wisp_chain_facts), set by the caller */
  uint32_t modes;        /* number of kinds of motion */
  uint32_t segments;     /* number of recorded pieces of motion */
  uint32_t history;      /* number of past modes that determine the next one */
  uint32_t gust_order;   /* order of the response to wind; 0: no response */
  uint32_t heading_free; /* 1 if segments are rotated about the vertical to join */
} wisp_chain_facts;

WISP_API wisp_status wisp_model_get_chain(const wisp_model* model, wisp_chain_facts* facts);

/* Read the probabilities of a recording's first mode (modes), and of transitions (modes * modes, a row per mode). */
WISP_API wisp_status wisp_model_chain_initial(const wisp_model* model, double* values, size_t count);
WISP_API wisp_status wisp_model_chain_transitions(const wisp_model* model, double* values, size_t count);

/* Reads mode and number of steps of each segment, wisp_chain_facts.segments values each. Either pointer may be NULL. */
WISP_API wisp_status wisp_model_chain_segments(const wisp_model* model, uint32_t* modes, uint32_t* steps, size_t count);

/* ---- Banks: instances of one model, stepped together ---- */

typedef struct wisp_bank wisp_bank;

/* Names an instance: slot in the lower 32 bits, generation in the upper. Ids of ended instances are not reused. */
typedef uint64_t wisp_instance;
#define WISP_NO_INSTANCE ((wisp_instance)0)

typedef struct wisp_bank_options {
  uint32_t size;            /* sizeof(wisp_bank_options), set by the caller */
  uint32_t capacity;        /* largest number of instances alive at once, 1 to 1048576; 0: 1 */
  uint32_t polyline_points; /* 2 to 4096; 0: 32 */
  uint32_t longest;         /* longest time that wisp_bank_advance() plays, milliseconds, 1 to 10000; 0: 10000 */
  uint64_t seed;            /* seed of all random streams of the bank; 0 is a seed too */
  void* memory;             /* memory for the bank; NULL: it allocates once, when it is created */
  size_t memory_size;       /* at least wisp_bank_bytes() */
} wisp_bank_options;

/* Returns the default options: capacity 1, 32 points, seed 1, memory of its own. */
WISP_API wisp_bank_options wisp_bank_default_options(void);

/* Computes the memory that a bank needs. `options` may be NULL for the defaults, here and below. */
WISP_API wisp_status wisp_bank_bytes(const wisp_model* model, const wisp_bank_options* options, size_t* bytes);

/* Creates an empty bank; memory given by the caller must outlive it. Sets *bank. */
WISP_API wisp_status wisp_bank_create(const wisp_model* model, const wisp_bank_options* options, wisp_bank** bank);

/* Frees a bank. NULL is allowed. */
WISP_API void wisp_bank_free(wisp_bank* bank);

typedef struct wisp_bank_facts {
  uint32_t size; /* sizeof(wisp_bank_facts), set by the caller */
  uint32_t capacity;
  uint32_t alive; /* number of instances alive */
  uint32_t slots; /* rows of every bulk buffer: one more than the highest slot in use */
  uint32_t inputs;
  uint32_t outputs;
  uint32_t polyline_points; /* 0 if the outputs are not an outline */
  uint32_t reserved;
  uint64_t clamped; /* instance-steps in which an output was clamped to its range */
  uint64_t steps;   /* all instance-steps; a model with more than 1 in 1000 clamped on ordinary input is not usable */
} wisp_bank_facts;

/* From here to wisp_bank_restore() is the frame path.
 *
 * Bulk buffers have one row per slot, or more: `count` is at least the stated one, so a buffer of capacity rows is
 * always large enough. Rows of empty slots, and those beyond, are ignored in inputs and zero in outputs. */

WISP_API wisp_status wisp_bank_get_facts(const wisp_bank* bank, wisp_bank_facts* facts);

/* Starts an instance at the model's operating point, with all inputs zero. Its random stream is the count of spawns so
 * far, or `stream`: instances with equal streams and inputs have equal outputs. Sets *instance. */
WISP_API wisp_status wisp_bank_spawn(wisp_bank* bank, wisp_instance* instance);
WISP_API wisp_status wisp_bank_spawn_stream(wisp_bank* bank, uint64_t stream, wisp_instance* instance);

WISP_API wisp_status wisp_bank_end(wisp_bank* bank, wisp_instance instance);

/* Returns 1 if the instance lives in this bank, else 0. */
WISP_API int32_t wisp_bank_alive(const wisp_bank* bank, wisp_instance instance);

/* Returns the instance in a slot; WISP_NO_INSTANCE for an empty slot. */
WISP_API wisp_instance wisp_bank_at(const wisp_bank* bank, uint32_t slot);

/* Set the inputs from the next step on, in their units: of all (slots * inputs), equal for all (inputs), of one
 * (inputs). NaN counts as 0; values outside the trained range extended by half its width are clamped. */
WISP_API wisp_status wisp_bank_set_inputs(wisp_bank* bank, const float* values, size_t count);
WISP_API wisp_status wisp_bank_set_common_inputs(wisp_bank* bank, const float* values, size_t count);
WISP_API wisp_status wisp_bank_set_instance_inputs(wisp_bank* bank, wisp_instance instance, const float* values,
                                                   size_t count);

/* Sets the scale of the residual noise: 1 as learned, 0 none; clamped to 0 … 10. A chain has no residual noise: at 0 it
 * always takes the likeliest mode and its best-joining segment, other scales change nothing. */
WISP_API wisp_status wisp_bank_set_noise(wisp_bank* bank, float scale);

/* Reads the current scale of the residual noise. */
WISP_API wisp_status wisp_bank_get_noise(const wisp_bank* bank, float* scale);

/* Makes one step of the model, whatever the time. */
WISP_API wisp_status wisp_bank_step(wisp_bank* bank);

/* Advances time and interpolates outputs between the last two steps, one step late. Negative time counts as 0, time
 * above the option `longest` as `longest`. Sets *steps, unless NULL, to the number of steps made. */
WISP_API wisp_status wisp_bank_advance(wisp_bank* bank, int64_t nanoseconds, int32_t* steps);

/* Advances time in seconds; NaN counts as 0. */
WISP_API wisp_status wisp_bank_advance_seconds(wisp_bank* bank, double seconds, int32_t* steps);

/* Makes up to 2^24 steps in one call, for offline play, with the same bits as single steps. Row t of steps * slots *
 * inputs values is set before step t, row t of steps * slots * outputs values is read after it; either may be NULL. */
WISP_API wisp_status wisp_bank_step_many(wisp_bank* bank, uint32_t steps, const float* inputs, size_t input_count,
                                         float* outputs, size_t output_count);

/* Callbacks by which threads of the caller step parts of a bank in parallel. `run` calls task(of, part) for every part
 * from 0 to parts - 1, each once and on any thread, and returns when all calls have returned. */
typedef void (*wisp_crew_task)(void* of, int32_t part);
typedef void (*wisp_crew_run)(void* pool, int32_t parts, wisp_crew_task task, void* of);

/* Distributes steps over a crew of 1 to 4096 parts from now on, with the same bits. `pool` is passed to `run`; if `run`
 * is NULL, the calling thread steps all instances. Worthwhile from some thousand instances on. */
WISP_API wisp_status wisp_bank_set_crew(wisp_bank* bank, uint32_t parts, wisp_crew_run run, void* pool);

/* Read outputs, in their units: of all (slots * outputs), of one (outputs). */
WISP_API wisp_status wisp_bank_outputs(const wisp_bank* bank, float* values, size_t count);
WISP_API wisp_status wisp_bank_instance_outputs(const wisp_bank* bank, wisp_instance instance, float* values,
                                                size_t count);

/* Read outlines as points, x and y alternating, from the base's left over the tip to the base's right: of all (slots *
 * polyline_points * 2), of one (polyline_points * 2). */
WISP_API wisp_status wisp_bank_polylines(const wisp_bank* bank, float* values, size_t count);
WISP_API wisp_status wisp_bank_polyline(const wisp_bank* bank, wisp_instance instance, float* values, size_t count);

/* For a model of a body, else WISP_BAD_ARGUMENT. The first sets the level camera that sees outputs and outlines, by its
 * unit vector to the right, (x, z). The second reads an instance's rings from base to tip, (polyline_points + 1) / 2
 * times 6 numbers: the centre's x, y, z, the radius, and the rise from centre to rim towards +x and +z. */
WISP_API wisp_status wisp_bank_look(wisp_bank* bank, float right_x, float right_z);
WISP_API wisp_status wisp_bank_rings(const wisp_bank* bank, wisp_instance instance, float* values, size_t count);

/* Compute the surface of 2 or more rings: rings * segments vertices, position and normal, `stride` >= 6 numbers apart,
 * segments from 3 to 256; and 2 * rings * segments - 4 triangles, anticlockwise from outside, equal in all frames. */
WISP_API wisp_status wisp_ring_mesh(const float* rings, uint32_t count, uint32_t segments, float* numbers, size_t room,
                                    size_t stride);
WISP_API wisp_status wisp_ring_triangles(uint32_t rings, uint32_t segments, uint32_t* indices, size_t count);

/* State of an instance's flame. In a model with a blow_out_level, wind that is too strong for too long extinguishes the
 * instance, until it is relit; outputs and outlines then shrink to 0. Times since these events, for smoke and ember,
 * are nanoseconds up to the displayed state, or WISP_NEVER. Light is that of an outline, and 0 for other views. */
#define WISP_WENT_OUT 1u
#define WISP_RELIT 2u
#define WISP_NEVER INT64_MAX
typedef struct wisp_flame_state {
  uint32_t size;     /* sizeof(wisp_flame_state), set by the caller */
  uint32_t lit;      /* 1 or 0 */
  float flame_size;  /* 0 to 1: factor that outputs already contain */
  uint32_t events;   /* sum of the flags above: events of the last call of step or advance, and by hand since */
  int64_t since_lit; /* since it was last relit; WISP_NEVER if never since spawned */
  int64_t since_out; /* since it was last extinguished */
  float light[3];    /* position: centroid of its outline, x, y, and z of a body */
  float intensity;   /* area relative to the area at rest */
  float kelvin;      /* colour temperature: 1900 at rest, times the 16th root of the intensity */
} wisp_flame_state;

WISP_API wisp_status wisp_bank_get_flame_state(const wisp_bank* bank, wisp_instance instance, wisp_flame_state* state);

/* Reads the flame_size of every slot: slots values. */
WISP_API wisp_status wisp_bank_flame_sizes(const wisp_bank* bank, float* values, size_t count);

/* Relight an extinguished instance, which grows from rest, or extinguish a burning one, whatever the wind; no effect on
 * others. WISP_BAD_ARGUMENT if the model has no blow_out_level: it is never extinguished. */
WISP_API wisp_status wisp_bank_relight(wisp_bank* bank, wisp_instance instance);
WISP_API wisp_status wisp_bank_extinguish(wisp_bank* bank, wisp_instance instance);

/* ---- Instances of a chain: bodies that fall, drift or fly. WISP_BAD_ARGUMENT for other dynamics ---- */

/* Position of an instance in its chain, and its motion. */
typedef struct wisp_chain_place {
  uint32_t size;     /* sizeof(wisp_chain_place), set by the caller */
  uint32_t segment;  /* index of the current segment */
  uint32_t step;     /* step within the segment; 0: where it joined the previous one */
  uint32_t mode;     /* mode of the segment */
  float velocity[3]; /* mean over the last step, metres per second */
  float spin[3];     /* radians per second, world axes */
  uint32_t lies;     /* 1: at rest on the ground */
  uint32_t landed;   /* 1: touched the ground in the last call of step or advance, and does not lie yet */
} wisp_chain_place;

WISP_API wisp_status wisp_bank_get_chain_place(const wisp_bank* bank, wisp_instance instance, wisp_chain_place* place);

/* A body at one moment, in the world: metres, seconds, radians, z up. */
typedef struct wisp_body {
  uint32_t size; /* sizeof(wisp_body), set by the caller */
  float position[3];
  float orientation[4]; /* body to world, w first; its norm does not matter */
  float velocity[3];
  float spin[3]; /* angular velocity, world axes */
} wisp_body;

/* Sets the state of an instance of a chain, as after a throw, a collision or a kick: it continues with the segment
 * whose initial motion is nearest; the difference decays. Searches every segment once: too expensive for every frame.
 * WISP_BAD_ARGUMENT if a number is not within +-1e6, or the orientation's norm is below 0.001. */
WISP_API wisp_status wisp_bank_place(wisp_bank* bank, wisp_instance instance, const wisp_body* body);

/* Position that a body is to reach, and the time until then. */
typedef struct wisp_target {
  uint32_t size;       /* sizeof(wisp_target), set by the caller */
  float position[3];   /* in the world, metres */
  int64_t nanoseconds; /* time from now; above 0, at most 10 000 s */
  float within;        /* tolerance, metres, 0.001 to 1000; 0: 0.1 */
} wisp_target;

/* Steers an instance of a chain (until the given time, joins prefer segments that lead to the target), or releases it.
 * Placing and resetting release it too. WISP_BAD_ARGUMENT if a number is out of range or the chain does not know the
 * displacement of its segments, as wisp_bank_can_steer() reports (1 or 0). */
WISP_API wisp_status wisp_bank_steer(wisp_bank* bank, wisp_instance instance, const wisp_target* target);
WISP_API wisp_status wisp_bank_release(wisp_bank* bank, wisp_instance instance);
WISP_API int32_t wisp_bank_can_steer(const wisp_bank* bank);

/* Set the height of level ground, on which instances of a chain come to rest until they are placed or reset; or remove
 * it (the default): they fall for ever. WISP_BAD_ARGUMENT for a height that is not finite; +-1e6 or more removes it. */
WISP_API wisp_status wisp_bank_set_ground(wisp_bank* bank, float height);
WISP_API wisp_status wisp_bank_clear_ground(wisp_bank* bank);

typedef struct wisp_chain_settings {
  uint32_t size;       /* sizeof(wisp_chain_settings), set by the caller */
  uint32_t has_ground; /* 0: none */
  float ground;
} wisp_chain_settings;

/* Reads the current height of the ground. */
WISP_API wisp_status wisp_bank_get_chain_settings(const wisp_bank* bank, wisp_chain_settings* settings);

/* Reset one instance, or all instances and the time passed since the last step, to the state at spawning, lit. */
WISP_API wisp_status wisp_bank_reset_instance(wisp_bank* bank, wisp_instance instance);
WISP_API wisp_status wisp_bank_reset(wisp_bank* bank);

/* Save the whole state as bytes, and restore it: the bank continues with the same bits. The same model and capacity are
 * needed. WISP_BAD_DATA if the bytes are damaged or of another model, capacity or version; only failure allocates. */
WISP_API wisp_status wisp_bank_save_bytes(const wisp_bank* bank, size_t* bytes);
WISP_API wisp_status wisp_bank_save(const wisp_bank* bank, void* bytes, size_t size);
WISP_API wisp_status wisp_bank_restore(wisp_bank* bank, const void* bytes, size_t size);

/* ---- Wind heard by a microphone ---- */

typedef struct wisp_wind wisp_wind;

typedef struct wisp_wind_options {
  uint32_t size;                   /* sizeof(wisp_wind_options), set by the caller */
  uint32_t channels;               /* interleaved channels of the sound, 1 to 8; 0: 1 */
  double rate_hz;                  /* samples per second of each channel, 8000 to 192000 */
  double frame_rate_hz;            /* frames of wind per second, 1 to 1000: best the model's rate */
  double exponent;                 /* exponent of wind speed as a power of the wind band's RMS, 0.1 to 2 */
  double smoothing_seconds;        /* averaging time of the level, 0 to 1 */
  double floor_rise_db_per_second; /* largest growth rate of the background estimate, 0 to 60 */
  double first_gust_rms;           /* initial RMS of the wind band (100 to 900 Hz) at wind 1, full scale 1, 1e-6 to 8 */
} wisp_wind_options;

/* Returns the default options: one channel of 44100 Hz, 60 frames per second (reasons: docs/explanation/wind.md). */
WISP_API wisp_wind_options wisp_wind_default_options(void);

/* Creates an estimator at the start of a stream of sound. `options` may be NULL for the defaults. Sets *wind.
 * WISP_BAD_ARGUMENT names the option that is out of its range. */
WISP_API wisp_status wisp_wind_create(const wisp_wind_options* options, wisp_wind** wind);

/* Frees an estimator. NULL is allowed. */
WISP_API void wisp_wind_free(wisp_wind* wind);

/* The wind during one frame. Frames come in arrays, so fields will never be added. Amplitudes are root mean squares
 * with full scale 1. */
typedef struct wisp_wind_frame {
  int64_t index;    /* frame k covers the sound from k / frame rate to (k + 1) / frame rate */
  float rms;        /* RMS of all samples in the frame */
  float rms_clean;  /* rms minus the background's RMS, at least 0 */
  float level;      /* RMS of the wind band (100 to 900 Hz, whitened) after its background's power is subtracted */
  float speed;      /* proportional to wind speed; 1 lies between soft breath and hard blowing */
  float wind;       /* a model's input: speed while the sound is like blowing, 0 if nothing is heard */
  float confidence; /* 0 to 1: that this is blowing, not talking */
  float background; /* RMS of the background as estimated at this frame */
  float clipped;    /* share of samples at full scale, 0 to 1 */
} wisp_wind_frame;

/* From here to wisp_wind_latency() is the frame path of sound: the thread that plays or records may call it.
 *
 * These functions consume interleaved samples, full scale +-1 or 16 bits, until they are used up or there is no room
 * for a frame; then feed the rest again. NaN counts as 0. Frames do not depend on the division of the sound into
 * blocks. *taken is set to the number of samples consumed, all channels counted, and *made to the number of frames
 * written; either may be NULL. `frames` may be NULL if `room` is 0: then only samples before a frame's end are
 * consumed. WISP_BAD_ARGUMENT if `count` is not a multiple of the channels. */
WISP_API wisp_status wisp_wind_feed(wisp_wind* wind, const float* samples, size_t count, wisp_wind_frame* frames,
                                    size_t room, size_t* taken, size_t* made);
WISP_API wisp_status wisp_wind_feed_int16(wisp_wind* wind, const int16_t* samples, size_t count,
                                          wisp_wind_frame* frames, size_t room, size_t* taken, size_t* made);

/* Reads the latest frame; all zero before the first. */
WISP_API wisp_status wisp_wind_latest(const wisp_wind* wind, wisp_wind_frame* frame);

/* Requests of a guided calibration. The background is estimated without a request. */
#define WISP_WIND_BREATHE_GENTLY 0u /* wind that leans a flame without extinguishing it */
#define WISP_WIND_BLOW_HARD 1u      /* wind that extinguishes a flame */

/* Calibrates as requested by the sound of the next `seconds`, clamped to 0.5 to 30. NaN is WISP_BAD_ARGUMENT. */
WISP_API wisp_status wisp_wind_calibrate(wisp_wind* wind, uint32_t what, double seconds);

/* Returns 1 while a calibration's seconds are still running, else 0. */
WISP_API int32_t wisp_wind_calibrating(const wisp_wind* wind);

/* Returns 1 if the last calibration has ended and heard at least 0.1 s of blowing, else 0. */
WISP_API int32_t wisp_wind_calibrated(const wisp_wind* wind);

/* Returns the rise of the room's level since its first seconds or its lowest since, dB, at least 0. From 6 on a steady
 * sound has begun (rain, a fan, an engine) that may be mistaken for wind; wisp_wind_reset() makes it the background. 0
 * for NULL. */
WISP_API double wisp_wind_room_rise(const wisp_wind* wind);

/* Estimated properties of a microphone in a room. A program may store them, and set them at its next start. */
typedef struct wisp_wind_calibration {
  uint32_t size;          /* sizeof(wisp_wind_calibration), set by the caller */
  float background_rms;   /* RMS without wind, 0 to 8 */
  float background_level; /* RMS of the wind band, without wind, 0 to 8 */
  float floor_db;         /* level without wind, dB of full scale, -200 to 40 */
  float gust_rms;         /* RMS of the wind band at wind 1, 0 to 8; 0: unknown */
} wisp_wind_calibration;

WISP_API wisp_status wisp_wind_get_calibration(const wisp_wind* wind, wisp_wind_calibration* calibration);
WISP_API wisp_status wisp_wind_set_calibration(wisp_wind* wind, const wisp_wind_calibration* calibration);

/* Forgets everything but the options. */
WISP_API wisp_status wisp_wind_reset(wisp_wind* wind);

/* Returns the delay by filters and smoothing, seconds, in addition to the duration of a frame. 0 for NULL. */
WISP_API double wisp_wind_latency(const wisp_wind* wind);

/* ---- Learning ----
 *
 * A recording is built from arrays; learning returns the bytes of a model, for wisp_model_load() or a file.
 *
 *     wisp_recipe recipe = wisp_recipe_default(WISP_RECIPE_ARX);
 *     wisp_recording_create(rate_hz, &recording);
 *     wisp_recording_add(recording, WISP_ROLE_INPUT, "wind", "", wind, rows);
 *     wisp_recording_add(recording, WISP_ROLE_OUTPUT, "lean", "m", lean, rows);
 *     wisp_learn(&recording, 1, &recipe, NULL, NULL, &fit);
 *     wisp_fit_get_model(fit, &bytes, &size);
 *
 * An input's wind may come from sound, by wisp_wind_feed(). A libwisp built without learning (WISP_BUILD_LEARN=OFF) and
 * the WebAssembly player lack these functions. */

typedef struct wisp_recording wisp_recording;

/* Role of a channel. */
enum {
  WISP_ROLE_INPUT = 0,  /* acts on the object (wind) */
  WISP_ROLE_OUTPUT = 1, /* behaviour of the object: a flame's p0.x, p0.y, ..., a leaf's pos.x, pos.y, pos.z, q.w, ... */
  WISP_ROLE_MOTION = 2  /* position of the object's support */
};

/* Creates an empty recording. Sets *recording. WISP_BAD_ARGUMENT unless 0 < rate_hz < 1e9 (samples per second). */
WISP_API wisp_status wisp_recording_create(double rate_hz, wisp_recording** recording);

/* Frees a recording. NULL is allowed. */
WISP_API void wisp_recording_free(wisp_recording* recording);

/* Adds a channel, whose samples are copied; NaN is a missing sample. All channels have equal counts. `unit` may be
 * NULL. Fails with WISP_BAD_DATA if the name is empty or exists already, or a sample is infinite. */
WISP_API wisp_status wisp_recording_add(wisp_recording* recording, uint32_t role, const char* name, const char* unit,
                                        const double* samples, size_t count);

/* Divides the rows into episodes: one id per row; no history crosses from one id to the next. */
WISP_API wisp_status wisp_recording_set_episodes(wisp_recording* recording, const int64_t* ids, size_t count);

/* Sets a fact about the whole recording, listed in docs/reference/recordings.md ("knots", "pair", ...). */
WISP_API wisp_status wisp_recording_set_attribute(wisp_recording* recording, const char* name, const char* value);

/* Kind of model to learn. */
enum {
  WISP_RECIPE_ARX = 1,     /* one ARX model of all inputs and outputs */
  WISP_RECIPE_OUTLINE = 2, /* control points of an outline */
  WISP_RECIPE_FLAME = 3,   /* an outline that wind extinguishes */
  WISP_RECIPE_CHAIN = 4,   /* pieces of motion, cut at an event */
  WISP_RECIPE_LEAF = 5,    /* a chain cut where a leaf stalls */
  WISP_RECIPE_FLICKER = 6  /* the light of a flame, for a lamp */
};

typedef struct wisp_recipe {
  uint32_t size;     /* sizeof(wisp_recipe), set by the caller */
  uint32_t kind;     /* WISP_RECIPE_... */
  int32_t na;        /* ARX: number of lags of outputs */
  int32_t nb;        /* ARX: number of lags of inputs */
  int32_t nk;        /* ARX: delay, samples; -1: estimated for each pair of channels */
  int32_t modes;     /* number of modes of a chain or a flicker; 0: the default of the kind */
  const char* event; /* event that cuts a chain, such as "min:horizontal_speed"; NULL: the default of the kind */
  const char* name;  /* name of the model; NULL: the default of the kind */
} wisp_recipe;

/* Returns the library's default recipe of that kind. Learning chooses the settings that it leaves open. */
WISP_API wisp_recipe wisp_recipe_default(uint32_t kind);

/* Called now and then on the calling thread with a stage in words and its finished share, 0 to 1, or below 0 if its
 * length is unknown. Returns 0 to stop. */
typedef int32_t (*wisp_progress)(void* of, const char* stage, double share);

typedef struct wisp_fit wisp_fit;

/* Learns one model from recordings. `progress` may be NULL. Sets *fit. A bad model is no failure: wisp_fit_usable()
 * reports it. Fails with WISP_BAD_DATA if the recordings cannot be learned from, with WISP_STOPPED if stopped, with
 * WISP_BAD_ARGUMENT for an unknown kind or event, or a number out of range. */
WISP_API wisp_status wisp_learn(const wisp_recording* const* recordings, size_t count, const wisp_recipe* recipe,
                                wisp_progress progress, void* of, wisp_fit** fit);

/* Frees a fit. NULL is allowed. */
WISP_API void wisp_fit_free(wisp_fit* fit);

/* Returns the bytes of the model's file, which live as long as the fit.
 * Fails with WISP_BAD_DATA if the learned model cannot be played. */
WISP_API wisp_status wisp_fit_get_model(const wisp_fit* fit, const void** bytes, size_t* size);

/* Return 1 if the model is fit for use, else 0, and the reason in one sentence, which lives as long as the fit. */
WISP_API int32_t wisp_fit_usable(const wisp_fit* fit);
WISP_API const char* wisp_fit_reason(const wisp_fit* fit);

#ifdef __cplusplus
}
#endif

#endif
