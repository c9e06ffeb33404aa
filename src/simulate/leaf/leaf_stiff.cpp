#include "simulate/leaf/leaf_stiff.hpp"

#include <cvode/cvode.h>
#include <nvector/nvector_serial.h>
#include <sundials/sundials_context.h>
#include <sunlinsol/sunlinsol_dense.h>
#include <sunmatrix/sunmatrix_dense.h>

#include <cmath>
#include <string>

namespace wisp::leaf {
namespace {

constexpr int kStates = 13;

State<double> read(N_Vector vector) {
  const double* y = N_VGetArrayPointer(vector);
  return {{y[0], y[1], y[2], y[3]}, {y[4], y[5], y[6]}, {y[7], y[8], y[9]}, {y[10], y[11], y[12]}};
}

void write(const State<double>& s, N_Vector vector) {
  const double values[kStates] = {s.attitude.w, s.attitude.x, s.attitude.y, s.attitude.z, s.position.x,
                                  s.position.y, s.position.z, s.velocity.x, s.velocity.y, s.velocity.z,
                                  s.spin.x,     s.spin.y,     s.spin.z};
  double* y = N_VGetArrayPointer(vector);
  for (int k = 0; k < kStates; ++k) y[k] = values[k];
}

struct FreeContext {
  void operator()(SUNContext context) const { SUNContext_Free(&context); }
};
struct FreeVector {
  void operator()(N_Vector vector) const { N_VDestroy(vector); }
};
struct FreeMatrix {
  void operator()(SUNMatrix matrix) const { SUNMatDestroy(matrix); }
};
struct FreeLinearSolver {
  void operator()(SUNLinearSolver solver) const { SUNLinSolFree(solver); }
};
struct FreeCvode {
  void operator()(void* memory) const { CVodeFree(&memory); }
};
template <class Handle, class Free>
using Owned = std::unique_ptr<std::remove_pointer_t<Handle>, Free>;

}  // namespace

// Members are freed from the last to the first: the context goes last.
struct StiffIntegrator::Solver {
  Constants<double> constants;
  const LeafWind* wind = nullptr;
  Owned<SUNContext, FreeContext> context;
  Owned<N_Vector, FreeVector> state;
  Owned<SUNMatrix, FreeMatrix> matrix;
  Owned<SUNLinearSolver, FreeLinearSolver> linear;
  Owned<void*, FreeCvode> cvode;

  static int rate(double seconds, N_Vector y, N_Vector change, void* self) {
    const Solver& solver = *static_cast<const Solver*>(self);
    const State<double> s = read(y);
    Air<double> air;
    if (!solver.wind->calm()) {
      const Vec<double> moving = rotation_of(s.attitude)(s.velocity);
      const WindSample sample = solver.wind->at(array_of(s.position), array_of(moving), seconds);
      air = {vec_of(sample.velocity), vec_of(sample.change)};
    }
    write(rate_of(solver.constants, s, air), change);
    return 0;
  }

  static int forward_speed(double, N_Vector y, double* value, void*) {
    *value = read(y).velocity.y;
    return 0;
  }

  // The correction that restores the attitude's length 1; removes the error estimate's component along it.
  static int project(double, N_Vector y, N_Vector correction, double, N_Vector error, void*) {
    const double* q = N_VGetArrayPointer(y);
    const double length = std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
    N_VConst(0, correction);
    double* c = N_VGetArrayPointer(correction);
    for (int k = 0; k < 4; ++k) c[k] = q[k] * (1 / length - 1);
    if (!error) return 0;
    double* e = N_VGetArrayPointer(error);
    const double along = (q[0] * e[0] + q[1] * e[1] + q[2] * e[2] + q[3] * e[3]) / (length * length);
    for (int k = 0; k < 4; ++k) e[k] -= along * q[k];
    return 0;
  }

  bool set_up(const State<double>& begin, double seconds, double tolerance) {
    SUNContext made = nullptr;
    if (SUNContext_Create(nullptr, &made) != 0) return false;
    context.reset(made);
    state.reset(N_VNew_Serial(kStates, made));
    matrix.reset(SUNDenseMatrix(kStates, kStates, made));
    linear.reset(SUNLinSol_Dense(state.get(), matrix.get(), made));
    cvode.reset(CVodeCreate(CV_BDF, made));
    if (!state || !matrix || !linear || !cvode) return false;
    write(begin, state.get());
    void* const memory = cvode.get();
    // Speeds are of the order of 1 m/s and attitudes of 1, so one absolute bound serves all.
    return CVodeInit(memory, rate, seconds, state.get()) == CV_SUCCESS &&
           CVodeSStolerances(memory, tolerance, tolerance) == CV_SUCCESS &&
           CVodeSetUserData(memory, this) == CV_SUCCESS &&
           CVodeSetLinearSolver(memory, linear.get(), matrix.get()) == CV_SUCCESS &&
           CVodeRootInit(memory, 1, forward_speed) == CV_SUCCESS && CVodeSetProjFn(memory, project) == CV_SUCCESS &&
           CVodeSetMaxNumSteps(memory, 200000) == CV_SUCCESS &&
           CVodeSetErrHandlerFn(
               memory, [](int, const char*, const char*, char*, void*) {}, nullptr) == CV_SUCCESS;
  }
};

StiffIntegrator::StiffIntegrator(std::unique_ptr<Solver> solver) : solver_(std::move(solver)) {}
StiffIntegrator::StiffIntegrator(StiffIntegrator&&) noexcept = default;
StiffIntegrator::~StiffIntegrator() = default;

Result<StiffIntegrator> StiffIntegrator::begin(const Constants<double>& constants, const LeafWind& wind,
                                               const State<double>& state, double seconds, double tolerance) {
  auto solver = std::make_unique<Solver>();
  solver->constants = constants;
  solver->wind = &wind;
  if (!solver->set_up(state, seconds, tolerance))
    return Error{"leaf: CVODE could not be set up, is there memory left?"};
  return StiffIntegrator(std::move(solver));
}

Result<State<double>> StiffIntegrator::advance_to(double seconds, std::vector<double>& stalls) {
  double reached = 0;
  for (;;) {
    const int outcome = CVode(solver_->cvode.get(), seconds, solver_->state.get(), &reached, CV_NORMAL);
    if (outcome == CV_ROOT_RETURN) {
      stalls.push_back(reached);
      continue;
    }
    if (outcome >= 0) return with_unit_attitude(read(solver_->state.get()));
    char* name = CVodeGetReturnFlagName(outcome);
    std::string message = "leaf: CVODE gave up at " + std::to_string(reached) + " s (" + name + ")";
    std::free(name);
    return Error{std::move(message)};
  }
}

std::int64_t StiffIntegrator::evaluations() const {
  long by_steps = 0, by_jacobians = 0;
  CVodeGetNumRhsEvals(solver_->cvode.get(), &by_steps);
  CVodeGetNumLinRhsEvals(solver_->cvode.get(), &by_jacobians);
  return by_steps + by_jacobians;
}

}  // namespace wisp::leaf
