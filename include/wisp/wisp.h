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

/* What the library shows. Who links the shared one on Windows defines WISP_SHARED. */
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

/* The version of the library that is linked: major * 1000000 + minor * 1000 + patch. */
WISP_API int32_t wisp_version(void);

typedef int32_t wisp_status;
enum {
  WISP_OK = 0,
  WISP_BAD_ARGUMENT = 1,     /* misuse: a null pointer, a wrong count, an option out of range */
  WISP_BAD_DATA = 2,         /* bytes from outside that are not what they should be */
  WISP_NO_INSTANCE_LEFT = 3, /* the bank is full */
  WISP_NOT_ALIVE = 4,        /* the instance has ended, or never was */
  WISP_NO_MEMORY = 5,
  WISP_STOPPED = 6 /* a wisp_progress said so */
};

/* One sentence about the last failure on this thread; "" before the first. Valid until the next failure on it. */
WISP_API const char* wisp_last_error(void);

/* ---- Models ---- */

typedef struct wisp_model wisp_model;

/* Reads a model from the bytes of a .wisp file; they are not needed afterwards. Sets *model.
 * Fails with WISP_BAD_DATA when they are not a whole, sound model of a known version. */
WISP_API wisp_status wisp_model_load(const void* bytes, size_t size, wisp_model** model);

/* Frees a model; banks made from it live on. NULL is fine. */
WISP_API void wisp_model_free(wisp_model* model);

/* A flame in the round, by rotational symmetry, as a model of its own: its wind is two inputs, x to the right of the
 * camera that filmed it and z towards that camera. */
WISP_API wisp_status wisp_model_in_the_round(const wisp_model* model, wisp_model** round);

/* What moves the outputs. */
enum {
  WISP_DYNAMICS_ARX = 1,     /* autoregression with exogenous inputs */
  WISP_DYNAMICS_CHAIN = 2,   /* pieces of recorded motion, one after another by chance */
  WISP_DYNAMICS_SWITCHED = 3 /* several ARX models, one of which acts at a time */
};

/* What the outputs mean. */
enum {
  WISP_VIEW_PLAIN = 0,   /* nothing but themselves */
  WISP_VIEW_OUTLINE = 1, /* control points x, y of a closed outline: x right, y up, mean height 1 */
  WISP_VIEW_POSE = 2,    /* position x, y, z in metres, z up; unit quaternion w, x, y, z, body to world */
  WISP_VIEW_POSITION = 3 /* position x, y, z in metres, z up */
};

typedef struct wisp_model_facts {
  uint32_t size;           /* sizeof(wisp_model_facts), set by the caller */
  uint32_t inputs;         /* external inputs; an input makes one regressor or more */
  uint32_t outputs;        /* for an outline: 2 * control_points, x and y in turn */
  uint32_t control_points; /* 0 where the outputs are not an outline */
  uint32_t usable;         /* 1 when learning found the model fit for use */
  uint32_t reserved;
  double rate_hz;         /* its own steps a second */
  double metres_per_unit; /* of an outline; 0 where it is not known */
  int64_t step_nanoseconds;
  int64_t multiply_adds_per_frame; /* by the paper's count: coefficients that are not zero */
  int64_t operations_per_frame;    /* all arithmetic, noise and a polyline of 32 points included. Both are what
                                      the learner wrote into the file, 0 if nothing */
  double blow_out_level;   /* wind of this strength blows an instance out, in the unit of its input; 0: nothing does, */
  double blow_out_seconds; /* when it lasts so long; stronger wind takes less */
  uint32_t dynamics;       /* one of WISP_DYNAMICS_* */
  uint32_t view;           /* WISP_VIEW_PLAIN, WISP_VIEW_OUTLINE, WISP_VIEW_POSE or WISP_VIEW_POSITION */
  double half_width;       /* metres, of a body with pose or position; 0 where it is not known */
  double half_length;      /* metres, of a body with pose; 0 where it is not known */
  double blow_out_haste;   /* at twice the level it lasts blow_out_seconds / (1 + blow_out_haste) */
  double blow_out_recovery_seconds; /* below the level, after which it is as if the wind had never blown */
  uint32_t blow_out_input;          /* which input blows it out */
  uint32_t reserved_2;
} wisp_model_facts;

/* Fills the fields that the caller's `size` has room for. */
WISP_API wisp_status wisp_model_get_facts(const wisp_model* model, wisp_model_facts* facts);

typedef struct wisp_channel {
  uint32_t size; /* sizeof(wisp_channel), set by the caller */
  uint32_t reserved;
  const char* name; /* these two live as long as the model */
  const char* unit;
  double lowest; /* the trained or seen range; clamped to it and half of it more */
  double highest;
  uint32_t splits_sign; /* of inputs: 1 when their size and their sign make regressors of their own */
  uint32_t reserved2;
} wisp_channel;

/* What input or output number `index`, from 0, is. */
WISP_API wisp_status wisp_model_get_input(const wisp_model* model, uint32_t index, wisp_channel* channel);
WISP_API wisp_status wisp_model_get_output(const wisp_model* model, uint32_t index, wisp_channel* channel);

/* The model's name; lives as long as the model. "" for NULL. */
WISP_API const char* wisp_model_name(const wisp_model* model);

/* ---- What a model says of itself. Texts live as long as the model. ---- */

typedef struct wisp_provenance {
  uint32_t size;    /* sizeof(wisp_provenance), set by the caller */
  uint32_t sources; /* how many there are of each */
  uint32_t options;
  uint32_t figures;
  uint32_t usable; /* 1 when learning found the model fit for use */
  uint32_t reserved;
  const char* program; /* name and version of what wrote it */
  const char* reason;  /* why it is fit for use, or why not */
} wisp_provenance;

/* A named fact: an option as given to the learner. */
typedef struct wisp_note {
  uint32_t size; /* sizeof(wisp_note), set by the caller */
  uint32_t reserved;
  const char* name;
  const char* value;
} wisp_note;

/* A named figure of how good the model is. */
typedef struct wisp_figure {
  uint32_t size; /* sizeof(wisp_figure), set by the caller */
  uint32_t reserved;
  const char* name;
  double value;
} wisp_figure;

WISP_API wisp_status wisp_model_get_provenance(const wisp_model* model, wisp_provenance* provenance);

/* Number `index`, from 0, of each. Sets *name to the file name of a recording that the model was learned from. */
WISP_API wisp_status wisp_model_get_source(const wisp_model* model, uint32_t index, const char** name);
WISP_API wisp_status wisp_model_get_option(const wisp_model* model, uint32_t index, wisp_note* option);
WISP_API wisp_status wisp_model_get_figure(const wisp_model* model, uint32_t index, wisp_figure* figure);

/* Of models whose dynamics are WISP_DYNAMICS_ARX; others are a WISP_BAD_ARGUMENT. */
typedef struct wisp_arx_facts {
  uint32_t size;       /* sizeof(wisp_arx_facts), set by the caller */
  uint32_t outputs;    /* rows of the matrices of orders */
  uint32_t regressors; /* inputs as the dynamics see them */
  uint32_t history;    /* steps that the longest lag reaches back */
  uint32_t shocks;     /* sources of noise that outputs share */
  uint32_t resamples;  /* 1 when recorded residuals are played again, 0 when the noise is Gaussian */
} wisp_arx_facts;

WISP_API wisp_status wisp_model_get_arx(const wisp_model* model, wisp_arx_facts* facts);

/* Matrices of orders, row by row: na (outputs * outputs), nb and nk (outputs * regressors). */
WISP_API wisp_status wisp_model_arx_na(const wisp_model* model, int32_t* values, size_t count);
WISP_API wisp_status wisp_model_arx_nb(const wisp_model* model, int32_t* values, size_t count);
WISP_API wisp_status wisp_model_arx_nk(const wisp_model* model, int32_t* values, size_t count);

/* Standard deviation of each output's own noise, in its unit: outputs. */
WISP_API wisp_status wisp_model_arx_noise(const wisp_model* model, double* values, size_t count);

/* Of models whose dynamics are WISP_DYNAMICS_CHAIN; others are a WISP_BAD_ARGUMENT. */
typedef struct wisp_chain_facts {
  uint32_t size;         /* sizeof(wisp_chain_facts), set by the caller */
  uint32_t modes;        /* kinds of motion */
  uint32_t segments;     /* pieces of recorded motion */
  uint32_t history;      /* modes that the next one depends on */
  uint32_t gust_order;   /* of the response to wind; 0: wind does nothing */
  uint32_t heading_free; /* 1 when segments are turned about the vertical to join */
} wisp_chain_facts;

WISP_API wisp_status wisp_model_get_chain(const wisp_model* model, wisp_chain_facts* facts);

/* Probabilities of how a recording begins (modes), and of what follows one mode (modes * modes, a row for each). */
WISP_API wisp_status wisp_model_chain_initial(const wisp_model* model, double* values, size_t count);
WISP_API wisp_status wisp_model_chain_transitions(const wisp_model* model, double* values, size_t count);

/* Mode and steps of each segment: segments. Either may be NULL. */
WISP_API wisp_status wisp_model_chain_segments(const wisp_model* model, uint32_t* modes, uint32_t* steps, size_t count);

/* ---- Banks: living instances of one model, stepped together ---- */

typedef struct wisp_bank wisp_bank;

/* Names an instance by value: slot in the lower 32 bits, generation in the upper. Ended ones are never named again. */
typedef uint64_t wisp_instance;
#define WISP_NO_INSTANCE ((wisp_instance)0)

typedef struct wisp_bank_options {
  uint32_t size;            /* sizeof(wisp_bank_options), set by the caller */
  uint32_t capacity;        /* most instances alive at once, 1 to 1048576; 0: 1 */
  uint32_t polyline_points; /* 2 to 4096; 0: 32 */
  uint32_t longest;         /* milliseconds that wisp_bank_advance() lets pass at most, 1 to 10000; 0: 10000 */
  uint64_t seed;            /* of all random streams of the bank; as it is, 0 too */
  void* memory;             /* where the bank lives; NULL: it allocates once, when it is made */
  size_t memory_size;       /* at least wisp_bank_bytes() */
} wisp_bank_options;

/* Options with every default: capacity 1, 32 points, seed 1, memory of its own. */
WISP_API wisp_bank_options wisp_bank_default_options(void);

/* How much memory a bank needs. `options` may be NULL for the defaults, here and below. */
WISP_API wisp_status wisp_bank_bytes(const wisp_model* model, const wisp_bank_options* options, size_t* bytes);

/* Makes an empty bank; memory that the caller gives must outlive it. Sets *bank. */
WISP_API wisp_status wisp_bank_create(const wisp_model* model, const wisp_bank_options* options, wisp_bank** bank);

/* Frees a bank. NULL is fine. */
WISP_API void wisp_bank_free(wisp_bank* bank);

typedef struct wisp_bank_facts {
  uint32_t size; /* sizeof(wisp_bank_facts), set by the caller */
  uint32_t capacity;
  uint32_t alive; /* instances */
  uint32_t slots; /* rows of every bulk buffer: one more than the highest slot in use */
  uint32_t inputs;
  uint32_t outputs;
  uint32_t polyline_points; /* 0 where the outputs are not an outline */
  uint32_t reserved;
  uint64_t clamped; /* steps of instances in which an output was clamped to its range, */
  uint64_t steps;   /* of so many; more than 1 in 1000 on ordinary input: the model is not usable */
} wisp_bank_facts;

/* From here to wisp_bank_restore() is the frame path.
 *
 * Bulk buffers have one row per slot, or more: `count` is at least the stated one, so a buffer of capacity rows always
 * serves. Rows of empty slots, and what lies beyond, are ignored on the way in and are zeros on the way out. */

WISP_API wisp_status wisp_bank_get_facts(const wisp_bank* bank, wisp_bank_facts* facts);

/* Starts an instance at the model's operating point, with all inputs zero. Its random stream is the count of spawns so
 * far, or `stream`: two instances of the same stream and inputs live the same life. Sets *instance. */
WISP_API wisp_status wisp_bank_spawn(wisp_bank* bank, wisp_instance* instance);
WISP_API wisp_status wisp_bank_spawn_stream(wisp_bank* bank, uint64_t stream, wisp_instance* instance);

WISP_API wisp_status wisp_bank_end(wisp_bank* bank, wisp_instance instance);

/* 1 when it lives in this bank, else 0. */
WISP_API int32_t wisp_bank_alive(const wisp_bank* bank, wisp_instance instance);

/* The instance in a slot; WISP_NO_INSTANCE when it is empty. */
WISP_API wisp_instance wisp_bank_at(const wisp_bank* bank, uint32_t slot);

/* What acts from the next step on, in the inputs' units: on all (slots * inputs), the same on all (inputs), on one
 * (inputs). What is not a number counts as 0; what is beyond the trained range and half of it is clamped. */
WISP_API wisp_status wisp_bank_set_inputs(wisp_bank* bank, const float* values, size_t count);
WISP_API wisp_status wisp_bank_set_common_inputs(wisp_bank* bank, const float* values, size_t count);
WISP_API wisp_status wisp_bank_set_instance_inputs(wisp_bank* bank, wisp_instance instance, const float* values,
                                                   size_t count);

/* Scale of the residual noise: 1 as learned, 0 none; clamped to 0 … 10. A chain has its chance in its walk: at 0 the
 * likeliest mode follows as the segment that joins best, any other scale leaves it as it is. */
WISP_API wisp_status wisp_bank_set_noise(wisp_bank* bank, float scale);

/* The scale as it is. */
WISP_API wisp_status wisp_bank_get_noise(const wisp_bank* bank, float* scale);

/* One step of the model, whatever the time. */
WISP_API wisp_status wisp_bank_step(wisp_bank* bank);

/* Lets time pass and shows what lies between the last two steps, one step late. Negative time counts as none, more than
 * the option `longest` as that. Sets *steps, unless NULL, to the steps made. */
WISP_API wisp_status wisp_bank_advance(wisp_bank* bank, int64_t nanoseconds, int32_t* steps);

/* The same with seconds; what is not a number counts as none. */
WISP_API wisp_status wisp_bank_advance_seconds(wisp_bank* bank, double seconds, int32_t* steps);

/* Many steps in one call, for play offline: the same bits as so many single ones. Row t of `inputs` (steps * slots *
 * inputs, or none) is set before step t and row t of `outputs` (steps * slots * outputs, or none) is read after it. */
WISP_API wisp_status wisp_bank_step_many(wisp_bank* bank, uint32_t steps, const float* inputs, size_t input_count,
                                         float* outputs, size_t output_count);

/* Threads of the caller's that step parts of a bank at once. `run` calls task(of, part) for every part from 0 below
 * `parts`, each once and on any thread, and returns when all calls have returned. */
typedef void (*wisp_crew_task)(void* of, int32_t part);
typedef void (*wisp_crew_run)(void* pool, int32_t parts, wisp_crew_task task, void* of);

/* From now on steps are shared by a crew, with the same bits; `pool` is handed to `run`. Worth its while from some
 * thousand instances on. NULL: the calling thread does all. */
WISP_API wisp_status wisp_bank_set_crew(wisp_bank* bank, uint32_t parts, wisp_crew_run run, void* pool);

/* Outputs, in their units: of all (slots * outputs), of one (outputs). */
WISP_API wisp_status wisp_bank_outputs(const wisp_bank* bank, float* values, size_t count);
WISP_API wisp_status wisp_bank_instance_outputs(const wisp_bank* bank, wisp_instance instance, float* values,
                                                size_t count);

/* Outlines as points, x and y in turn, from the base's left over the tip to the base's right: of all
 * (slots * polyline_points * 2), of one (polyline_points * 2). */
WISP_API wisp_status wisp_bank_polylines(const wisp_bank* bank, float* values, size_t count);
WISP_API wisp_status wisp_bank_polyline(const wisp_bank* bank, wisp_instance instance, float* values, size_t count);

/* Of a model in the round: outputs and outlines are seen, level, by a camera whose right is (x, z), of length 1. Rings
 * of an instance, (polyline_points + 1) / 2 times 6 numbers from the base to the tip: the middle's x, y, z, the radius,
 * and by how much it rises to its rim towards +x and +z. */
WISP_API wisp_status wisp_bank_look(wisp_bank* bank, float right_x, float right_z);
WISP_API wisp_status wisp_bank_rings(const wisp_bank* bank, wisp_instance instance, float* values, size_t count);

/* The surface of `rings` rings: rings * segments vertices, place and normal, `stride` numbers apart, segments from 3 to
 * 256; and 2 * rings * segments - 4 triangles of three indices, anticlockwise from outside, the same in all frames. */
WISP_API wisp_status wisp_ring_mesh(const float* rings, uint32_t count, uint32_t segments, float* numbers, size_t room,
                                    size_t stride);
WISP_API wisp_status wisp_ring_triangles(uint32_t rings, uint32_t segments, uint32_t* indices, size_t count);

/* Whether an instance burns. Those of a model with a blow_out_level go out when the wind is too strong for too long,
 * and stay out whatever the wind does then. Outputs and outlines shrink to 0 by themselves; for smoke and ember there
 * is the time since, in nanoseconds of what is shown, or WISP_NEVER. Of an outline, the light too. */
#define WISP_WENT_OUT 1u
#define WISP_RELIT 2u
#define WISP_NEVER INT64_MAX
typedef struct wisp_flame_state {
  uint32_t size;     /* sizeof(wisp_flame_state), set by the caller */
  uint32_t lit;      /* 1 or 0 */
  float flame_size;  /* 0 to 1: what outputs are already multiplied by */
  uint32_t events;   /* sum of the above: in the last call of step or advance, or by hand since */
  int64_t since_lit; /* since it was last lit again; one that was spawned lit was not */
  int64_t since_out; /* since it last went out */
  float light[3];    /* the middle of its outline, x, y, and z in the round */
  float intensity;   /* its area against that at rest */
  float kelvin;      /* colour temperature: 1900 at rest, redder where it is less */
} wisp_flame_state;

WISP_API wisp_status wisp_bank_get_flame_state(const wisp_bank* bank, wisp_instance instance, wisp_flame_state* state);

/* The flame_size of all: slots. */
WISP_API wisp_status wisp_bank_flame_sizes(const wisp_bank* bank, float* values, size_t count);

/* Lights an instance that is out: it starts from rest and grows. Puts one out, whatever the wind. Either does nothing
 * to one that is so already. WISP_BAD_ARGUMENT where the model has no blow_out_level: it never goes out. */
WISP_API wisp_status wisp_bank_relight(wisp_bank* bank, wisp_instance instance);
WISP_API wisp_status wisp_bank_extinguish(wisp_bank* bank, wisp_instance instance);

/* ---- Instances of a chain: things that fall, drift or fly. WISP_BAD_ARGUMENT where the dynamics are no chain ---- */

/* Where in its chain an instance is, and how it moves. */
typedef struct wisp_chain_place {
  uint32_t size;     /* sizeof(wisp_chain_place), set by the caller */
  uint32_t segment;  /* that is played; */
  uint32_t step;     /* how far: at 0 it was joined to the one before */
  uint32_t mode;     /* of the segment */
  float velocity[3]; /* over the last step, metres a second */
  float spin[3];     /* radians a second, world axes */
  uint32_t lies;     /* 1: at rest on the ground */
  uint32_t landed;   /* 1: touched it in the last call of step or advance, the last 0.35 s of a longer one */
} wisp_chain_place;

WISP_API wisp_status wisp_bank_get_chain_place(const wisp_bank* bank, wisp_instance instance, wisp_chain_place* place);

/* A body at one moment, in the world: metres, seconds, radians, z up. */
typedef struct wisp_body {
  uint32_t size; /* sizeof(wisp_body), set by the caller */
  float position[3];
  float orientation[4]; /* body to world, w first; its length does not matter */
  float velocity[3];
  float spin[3]; /* angular velocity, world axes */
} wisp_body;

/* Sets an instance of a chain where a body is, as after a throw, a collision or a kick: it goes on with the segment
 * that begins most as the body moves, the rest fading away. Looks at every segment once: not for every frame.
 * WISP_BAD_ARGUMENT where a number is not finite. */
WISP_API wisp_status wisp_bank_place(wisp_bank* bank, wisp_instance instance, const wisp_body* body);

/* Where a body is to be, and when. */
typedef struct wisp_target {
  uint32_t size;       /* sizeof(wisp_target), set by the caller */
  float position[3];   /* in the world, metres */
  int64_t nanoseconds; /* from now; above 0, at most 10 000 s */
  float within;        /* metres, 0.001 to 1000: how near is near enough; 0: 0.1 */
} wisp_target;

/* Steers an instance of a chain: at joins it prefers what leads to the target, until the time has come; or lets it fall
 * as it will. Placing and resetting end it too. WISP_BAD_ARGUMENT where a number is out of its range or the chain does
 * not know where its segments lead, which wisp_bank_can_steer() says (1 or 0). */
WISP_API wisp_status wisp_bank_steer(wisp_bank* bank, wisp_instance instance, const wisp_target* target);
WISP_API wisp_status wisp_bank_release(wisp_bank* bank, wisp_instance instance);
WISP_API int32_t wisp_bank_can_steer(const wisp_bank* bank);

/* Level ground at that height, on which instances of a chain come to rest until they are placed or reset; or none, as
 * at first: they fall for ever. WISP_BAD_ARGUMENT for a height that is not finite. */
WISP_API wisp_status wisp_bank_set_ground(wisp_bank* bank, float height);
WISP_API wisp_status wisp_bank_clear_ground(wisp_bank* bank);

typedef struct wisp_chain_settings {
  uint32_t size;       /* sizeof(wisp_chain_settings), set by the caller */
  uint32_t has_ground; /* 0: none */
  float ground;
} wisp_chain_settings;

/* What was set. */
WISP_API wisp_status wisp_bank_get_chain_settings(const wisp_bank* bank, wisp_chain_settings* settings);

/* Back to where they were when spawned, lit: one, or all and the bank's time. */
WISP_API wisp_status wisp_bank_reset_instance(wisp_bank* bank, wisp_instance instance);
WISP_API wisp_status wisp_bank_reset(wisp_bank* bank);

/* The whole state as bytes, and back: a bank restored goes on with the same bits. The same model and capacity are
 * needed. Restoring fails with WISP_BAD_DATA when the bytes are damaged or of another model, capacity or version. */
WISP_API wisp_status wisp_bank_save_bytes(const wisp_bank* bank, size_t* bytes);
WISP_API wisp_status wisp_bank_save(const wisp_bank* bank, void* bytes, size_t size);
WISP_API wisp_status wisp_bank_restore(wisp_bank* bank, const void* bytes, size_t size);

/* ---- Wind heard by a microphone ---- */

typedef struct wisp_wind wisp_wind;

typedef struct wisp_wind_options {
  uint32_t size;                   /* sizeof(wisp_wind_options), set by the caller */
  uint32_t channels;               /* interleaved channels of the sound, 1 to 8; 0: 1 */
  double rate_hz;                  /* samples a second of each channel, 8000 to 192000 */
  double frame_rate_hz;            /* frames of wind a second, 1 to 1000: the model's rate serves it best */
  double exponent;                 /* wind speed goes as the sound's RMS to this power, 0.1 to 2 */
  double smoothing_seconds;        /* mean of the level over this time, 0 to 1 */
  double floor_rise_db_per_second; /* how fast the background is believed to grow, 0 to 60 */
  double first_gust_rms;           /* wind 1 before any blowing was heard, full scale 1, 1e-6 to 8 */
} wisp_wind_options;

/* Options with every default: one channel of 44100 Hz, 60 frames a second; docs/explanation/wind.md has the reasons. */
WISP_API wisp_wind_options wisp_wind_default_options(void);

/* Makes an estimator at the start of a stream of sound. `options` may be NULL for the defaults. Sets *wind.
 * WISP_BAD_ARGUMENT names the option that is out of its range. */
WISP_API wisp_status wisp_wind_create(const wisp_wind_options* options, wisp_wind** wind);

/* Frees an estimator. NULL is fine. */
WISP_API void wisp_wind_free(wisp_wind* wind);

/* The wind during one frame. It comes in arrays, so it stays as it is: fields will not be added. Amplitudes are root
 * mean squares with full scale 1. */
typedef struct wisp_wind_frame {
  int64_t index;    /* frame k covers the sound from k / frame rate to (k + 1) / frame rate */
  float rms;        /* of all samples in the frame */
  float rms_clean;  /* less the background's, not below 0 */
  float level;      /* of the band in which wind is heard, less the background in power */
  float speed;      /* proportional to wind speed; 1 lies between soft breath and hard blowing */
  float wind;       /* a model's input: speed where it sounds like blowing, 0 where nothing is heard */
  float confidence; /* 0 to 1: this is blowing, not talking */
  float background; /* RMS of the background as known at this frame */
  float clipped;    /* share of samples at full scale, 0 to 1 */
} wisp_wind_frame;

/* From here to wisp_wind_latency() is the frame path of sound: it may be called by the thread that plays or records.
 *
 * Takes interleaved samples, full scale +-1 or 16 bits, until they are used up or there is no room for a frame; feed
 * the rest again then. What is not a number counts as 0. Frames do not depend on how the sound was cut into blocks.
 * Sets *taken to the samples taken, all channels counted, and *made to the frames written; either may be NULL. `frames`
 * may be NULL where `room` is 0: nothing is taken then that would make a frame. WISP_BAD_ARGUMENT when `count` is not a
 * multiple of the channels. */
WISP_API wisp_status wisp_wind_feed(wisp_wind* wind, const float* samples, size_t count, wisp_wind_frame* frames,
                                    size_t room, size_t* taken, size_t* made);
WISP_API wisp_status wisp_wind_feed_int16(wisp_wind* wind, const int16_t* samples, size_t count,
                                          wisp_wind_frame* frames, size_t room, size_t* taken, size_t* made);

/* The latest frame made; all zero before the first. */
WISP_API wisp_status wisp_wind_latest(const wisp_wind* wind, wisp_wind_frame* frame);

/* What a guided calibration asks for. The room needs none. */
#define WISP_WIND_BREATHE_GENTLY 0u /* what is to lean a flame and not to put it out */
#define WISP_WIND_BLOW_HARD 1u      /* what is to put it out */

/* Takes the coming seconds of sound (0.5 to 30 used) for what was requested. */
WISP_API wisp_status wisp_wind_calibrate(wisp_wind* wind, uint32_t what, double seconds);

/* 1 while that time is still running, else 0. */
WISP_API int32_t wisp_wind_calibrating(const wisp_wind* wind);

/* 1 when the last calibration is over and heard what it asked for. */
WISP_API int32_t wisp_wind_calibrated(const wisp_wind* wind);

/* How much louder the room is by now than in its first seconds or ever since, dB, not below 0. From 6 on something
 * steady has begun (rain, a fan, an engine) that may be taken for wind; after wisp_wind_reset() it is the room. 0 for
 * NULL. */
WISP_API double wisp_wind_room_rise(const wisp_wind* wind);

/* What a microphone in a room was found to be: kept, it spares the next start the finding. */
typedef struct wisp_wind_calibration {
  uint32_t size;          /* sizeof(wisp_wind_calibration), set by the caller */
  float background_rms;   /* RMS without wind */
  float background_level; /* RMS of the band in which wind is heard, without wind */
  float floor_db;         /* loudness without wind, dB of full scale */
  float gust_rms;         /* RMS of the band at wind 1; 0: not known yet */
} wisp_wind_calibration;

WISP_API wisp_status wisp_wind_get_calibration(const wisp_wind* wind, wisp_wind_calibration* calibration);
WISP_API wisp_status wisp_wind_set_calibration(wisp_wind* wind, const wisp_wind_calibration* calibration);

/* Forgets everything but the options. */
WISP_API wisp_status wisp_wind_reset(wisp_wind* wind);

/* Seconds between wind and the frame that tells of it, beyond the frame itself. 0 for NULL. */
WISP_API double wisp_wind_latency(const wisp_wind* wind);

/* ---- Learning ----
 *
 * A recording is put together from arrays; what is learned from it are the bytes of a model, which wisp_model_load()
 * takes and any file may keep.
 *
 *     wisp_recipe recipe = wisp_recipe_default(WISP_RECIPE_ARX);
 *     wisp_recording_create(rate_hz, &recording);
 *     wisp_recording_add(recording, WISP_ROLE_INPUT, "wind", "", wind, rows);
 *     wisp_recording_add(recording, WISP_ROLE_OUTPUT, "lean", "m", lean, rows);
 *     wisp_learn(&recording, 1, &recipe, NULL, NULL, &fit);
 *     wisp_fit_get_model(fit, &bytes, &size);
 *
 * The wind of an input may come from sound, by wisp_wind_feed(). A libwisp that was built without learning
 * (WISP_BUILD_LEARN=OFF) and the WebAssembly player do not have these functions. */

typedef struct wisp_recording wisp_recording;

/* What a channel is. */
enum {
  WISP_ROLE_INPUT = 0,  /* acts on the thing (wind) */
  WISP_ROLE_OUTPUT = 1, /* what the thing does: a flame's p0.x, p0.y, ..., a leaf's pos.x, pos.y, pos.z, q.w, ... */
  WISP_ROLE_MOTION = 2  /* where the thing is held */
};

/* An empty recording of so many samples a second. Sets *recording. */
WISP_API wisp_status wisp_recording_create(double rate_hz, wisp_recording** recording);

/* Frees a recording. NULL is fine. */
WISP_API void wisp_recording_free(wisp_recording* recording);

/* Adds a channel, whose samples are copied; NaN is a missing sample. All channels have the count of the first. `unit`
 * may be NULL. Fails with WISP_BAD_DATA when the name is there already or a sample is infinite. */
WISP_API wisp_status wisp_recording_add(wisp_recording* recording, uint32_t role, const char* name, const char* unit,
                                        const double* samples, size_t count);

/* Cuts the rows into episodes: one id for each row; no history crosses from one id to the next. */
WISP_API wisp_status wisp_recording_set_episodes(wisp_recording* recording, const int64_t* ids, size_t count);

/* A fact about the whole recording, as docs/reference/recordings.md lists them ("knots", "pair", ...). */
WISP_API wisp_status wisp_recording_set_attribute(wisp_recording* recording, const char* name, const char* value);

/* What is learned. */
enum {
  WISP_RECIPE_ARX = 1,     /* one ARX model of all inputs and outputs */
  WISP_RECIPE_OUTLINE = 2, /* control points of an outline */
  WISP_RECIPE_FLAME = 3,   /* an outline that wind extinguishes */
  WISP_RECIPE_CHAIN = 4,   /* pieces of motion, cut at an event */
  WISP_RECIPE_LEAF = 5,    /* the same, cut where a leaf stalls */
  WISP_RECIPE_FLICKER = 6  /* the light of a flame, for a lamp */
};

typedef struct wisp_recipe {
  uint32_t size;     /* sizeof(wisp_recipe), set by the caller */
  uint32_t kind;     /* WISP_RECIPE_... */
  int32_t na;        /* ARX: lags of outputs, */
  int32_t nb;        /* lags of inputs, */
  int32_t nk;        /* and delay, samples; -1: found for each pair of channels */
  int32_t modes;     /* of a chain or a flicker; 0: as the recipe has it */
  const char* event; /* a chain's, such as "min:horizontal_speed"; NULL: as the recipe has it */
  const char* name;  /* of the model; NULL: as the recipe has it */
} wisp_recipe;

/* The recipe as the library has it; what it leaves open is decided by held-out data. */
WISP_API wisp_recipe wisp_recipe_default(uint32_t kind);

/* Called now and then on the calling thread with a stage in words and the share of it that is done, 0 to 1, or below 0
 * where its length is unknown. Returns 0 to stop. */
typedef int32_t (*wisp_progress)(void* of, const char* stage, double share);

typedef struct wisp_fit wisp_fit;

/* Learns one model from recordings. `progress` may be NULL. Sets *fit. That the model came out badly is no failure:
 * wisp_fit_usable() says so.
 * Fails with WISP_BAD_DATA when the recordings cannot be learned from, with WISP_STOPPED when stopped. */
WISP_API wisp_status wisp_learn(const wisp_recording* const* recordings, size_t count, const wisp_recipe* recipe,
                                wisp_progress progress, void* of, wisp_fit** fit);

/* Frees a fit. NULL is fine. */
WISP_API void wisp_fit_free(wisp_fit* fit);

/* Hands out the bytes of the model's file, which live as long as the fit.
 * Fails with WISP_BAD_DATA when what was learned cannot be played. */
WISP_API wisp_status wisp_fit_get_model(const wisp_fit* fit, const void** bytes, size_t* size);

/* 1 when the model is fit for use, and why or why not, in a sentence. */
WISP_API int32_t wisp_fit_usable(const wisp_fit* fit);
WISP_API const char* wisp_fit_reason(const wisp_fit* fit);

#ifdef __cplusplus
}
#endif

#endif
