#include <akmon/contact/coupled/newton_lanes.h>

#include <algorithm>
#include <limits>

namespace akmon
{
  namespace
  {
    constexpr double largest = std::numeric_limits<double>::max();

    double *
    numbers_of(Lanes &lanes)
    {
      return reinterpret_cast<double *>(&lanes);
    }
  } // namespace


  void
  NewtonLanes::solve(std::vector<Problem> &problems)
  {
    pack(problems);
    evaluate();
    enough = maximum(0.5 * tolerance, 0.1 * error_of_compliance());
    for (unsigned int k = 0; k < most_steps; ++k)
      {
        choose_faces();
        evaluate();
        const Lanes residual = measure();
        settle(residual);
        lose_patience(residual);
        if (xsimd::none(active))
          break;
        newton_step();
        evaluate();
      }
    unpack(problems);
  }


  // Lanes of no problem, and pairs that a problem does not have, are open.
  void
  NewtonLanes::clear_lanes()
  {
    const unsigned int rows = 3 * n;
    A.assign(rows * rows, Lanes(0.));
    for (auto *const v : {&b, &t, &w, &reference})
      v->assign(rows, Lanes(0.));
    for (auto *const v : {&mu, &weight})
      v->assign(n, Lanes(0.));
    faces.resize(n);
    system.reinit(n);
    for (Lanes *const v : {&compliance, &step, &tolerance, &sufficient})
      *v = Lanes(1.);
    for (Lanes *const v : {&steps_since_best, &n_references, &n_applications, &final_residual})
      *v = Lanes(0.);
    best = last_error = Lanes(largest);
  }


  void
  NewtonLanes::pack(const std::vector<Problem> &problems)
  {
    n = 0;
    for (const Problem &problem : problems)
      n = std::max(n, static_cast<unsigned int>(problem.t->size()));
    clear_lanes();
    alignas(lane_alignment) double is_there[n_lanes] = {};
    for (unsigned int lane = 0; lane < problems.size(); ++lane)
      {
        pack_into(lane, problems[lane]);
        is_there[lane] = 1.;
      }
    active = Lanes::load_aligned(is_there) > Lanes(0.);
    solved = Lanes(0.) > Lanes(0.);
  }


  void
  NewtonLanes::pack_into(const unsigned int lane, const Problem &problem)
  {
    const auto &data   = *problem.data;
    const auto &matrix = *problem.A;
    const auto &start  = *problem.t;
    const auto set     = [&](Lanes &lanes, const double x) { numbers_of(lanes)[lane] = x; };
    for (unsigned int j = 0; j < matrix.cols(); ++j) // as it lies in memory: symmetric
      for (unsigned int i = 0; i < matrix.rows(); ++i)
        set(A[3 * n * j + i], matrix(i, j));
    for (unsigned int i = 0; i < start.size(); ++i)
      {
        for (unsigned int d = 0; d < 3; ++d)
          {
            set(b[3 * i + d], data.b[i][d]);
            set(t[3 * i + d], start[i][d]);
            set(reference[3 * i + d], data.start_is_reference ? start[i][d] : 0.);
          }
        set(mu[i], data.friction[i]);
        set(weight[i], data.weights[i]);
      }
    set(compliance, data.compliance);
    set(step, 1.9 / (data.norm + data.compliance));
    set(tolerance, data.tolerance);
    set(sufficient, data.sufficient);
  }


  // w = A t + b + c (t - t_0)
  void
  NewtonLanes::evaluate()
  {
    const unsigned int rows = 3 * n;
    for (unsigned int i = 0; i < rows; ++i)
      {
        Lanes sum = b[i] + compliance * (t[i] - reference[i]);
        for (unsigned int j = 0; j < rows; ++j)
          sum = xsimd::fma(A[rows * i + j], t[j], sum);
        w[i] = sum;
      }
    n_applications += select(active, Lanes(1.), Lanes(0.));
  }


  // CoulombFace::predicted_by() for q = t - w, and the forces taken there.
  void
  NewtonLanes::choose_faces()
  {
    for (unsigned int i = 0; i < n; ++i)
      {
        Face &face       = faces[i];
        Lanes *const t_i = &t[3 * i];
        const Lanes q_n = t_i[0] - w[3 * i], q_1 = t_i[1] - w[3 * i + 1],
                    q_2    = t_i[2] - w[3 * i + 2];
        const Lanes r      = mu[i] * maximum(q_n, Lanes(0.));
        const Lanes size   = square_root(q_1 * q_1 + q_2 * q_2);
        const Mask rubs    = r > Lanes(0.);
        face.normal        = q_n > Lanes(0.);
        face.disc          = rubs & (size < r);
        face.circle        = rubs & !(size < r);
        const Lanes length = select(face.circle, size, Lanes(1.));
        face.slip_1        = select(face.circle, q_1 / length, Lanes(1.));
        face.slip_2        = select(face.circle, q_2 / length, Lanes(0.));
        face.curvature = select(face.circle, (size - r) / select(rubs, r, Lanes(1.)), Lanes(0.));
        face.mu        = select(face.circle, mu[i], Lanes(0.));

        const Lanes limit = face.mu * maximum(t_i[0], Lanes(0.));
        t_i[0]            = select(face.normal | !active, t_i[0], Lanes(0.));
        t_i[1]            = select(face.disc | !active, t_i[1], limit * face.slip_1);
        t_i[2]            = select(face.disc | !active, t_i[2], limit * face.slip_2);
      }
  }


  // CompliantProblem::measure(). What is no number stays that.
  Lanes
  NewtonLanes::measure() const
  {
    Lanes residual(0.);
    for (unsigned int i = 0; i < n; ++i)
      {
        const Lanes *const t_i = &t[3 * i];
        const Lanes *const w_i = &w[3 * i];
        const Lanes q_n = t_i[0] - step * w_i[0], q_1 = t_i[1] - step * w_i[1],
                    q_2    = t_i[2] - step * w_i[2];
        const Lanes limit  = mu[i] * maximum(t_i[0], Lanes(0.));
        const Lanes size   = square_root(q_1 * q_1 + q_2 * q_2);
        const Mask is_out  = size > limit;
        const Lanes factor = select(is_out, limit / select(is_out, size, Lanes(1.)), Lanes(1.));
        const Lanes d_n    = t_i[0] - select(q_n <= Lanes(0.), Lanes(0.), q_n),
                    d_1 = t_i[1] - factor * q_1, d_2 = t_i[2] - factor * q_2;
        const Lanes squares = d_n * d_n + d_1 * d_1 + d_2 * d_2;
        const Lanes part    = weight[i] * square_root(squares) / step;
        residual            = select((part <= residual) | !(residual == residual), residual, part);
      }
    return residual;
  }


  Lanes
  NewtonLanes::error_of_compliance() const
  {
    Lanes error(0.);
    for (unsigned int i = 0; i < n; ++i)
      {
        Lanes squares(0.);
        for (unsigned int d = 0; d < 3; ++d)
          {
            const Lanes change = t[3 * i + d] - reference[3 * i + d];
            squares += change * change;
          }
        error = maximum(error, compliance * weight[i] * square_root(squares));
      }
    return error;
  }


  // Lanes that are solved for their reference are done, or go on with another one.
  void
  NewtonLanes::settle(const Lanes &residual)
  {
    constexpr double most_references = 4.;

    const Mask settled = active & (residual <= enough);
    if (xsimd::none(settled))
      return;
    const Lanes error = error_of_compliance();
    const Mask done   = settled &
                      ((error <= tolerance) | ((error <= sufficient) & (error > 0.5 * last_error)));
    solved         = solved | (done & (residual <= sufficient));
    final_residual = select(done, maximum(residual, error), final_residual);
    active         = active & !done;

    const Mask refer = settled & !done;
    n_references += select(refer, Lanes(1.), Lanes(0.));
    active     = active & !(refer & (n_references > Lanes(most_references)));
    last_error = select(refer, error, last_error);
    enough     = select(refer, 0.5 * tolerance, enough);
    best       = select(refer, Lanes(largest), best);
    for (unsigned int i = 0; i < 3 * n; ++i)
      {
        w[i]         = select(refer, w[i] - compliance * (t[i] - reference[i]), w[i]);
        reference[i] = select(refer, t[i], reference[i]);
      }
  }


  // Lanes that do not come closer are given up.
  void
  NewtonLanes::lose_patience(const Lanes &residual)
  {
    constexpr double patience = 4.;

    const Mask closer = residual < 0.9 * best;
    best              = select(closer, residual, best);
    steps_since_best  = select(closer, Lanes(0.), steps_since_best + Lanes(1.));
    active            = active & (steps_since_best < Lanes(patience));
  }


  // t + L p with w + (A L + c) p = 0 in the free directions (PairPreconditioner), where turning
  // along a circle counts with its curvature.
  void
  NewtonLanes::newton_step()
  {
    make_jacobian();
    active       = active & system.solve();
    const auto p = [&](const unsigned int row) { return system.right_hand(row); };
    for (unsigned int i = 0; i < n; ++i)
      {
        const Face &face  = faces[i];
        const Lanes along = p(3 * i + 1), slip = p(3 * i + 2) + face.mu * p(3 * i);
        t[3 * i]     = select(active, t[3 * i] + p(3 * i), t[3 * i]);
        t[3 * i + 1] = select(active,
                              t[3 * i + 1] - along * face.slip_2 + slip * face.slip_1,
                              t[3 * i + 1]);
        t[3 * i + 2] = select(active,
                              t[3 * i + 2] + along * face.slip_1 + slip * face.slip_2,
                              t[3 * i + 2]);
      }
  }


  // In directions of the pairs' faces: the normal, along the circle, and that of slip, which is
  // free on a disc only. Rows and columns that are not free are those of the unit matrix.
  void
  NewtonLanes::make_jacobian()
  {
    for (unsigned int i = 0; i < n; ++i)
      {
        for (unsigned int j = 0; j < n; ++j)
          make_block(i, j);
        const Face &face   = faces[i];
        const auto is_free = face.free_directions();
        const Lanes w_1 = w[3 * i + 1], w_2 = w[3 * i + 2];
        const Lanes motion[]     = {w[3 * i],
                                    face.slip_1 * w_2 - face.slip_2 * w_1,
                                    face.slip_1 * w_1 + face.slip_2 * w_2};
        const Lanes curvatures[] = {Lanes(0.), face.curvature, Lanes(0.)};
        for (unsigned int d = 0; d < 3; ++d)
          {
            const unsigned int row = 3 * i + d;
            Lanes &diagonal        = system(row, row);
            diagonal = select(is_free[d], diagonal + compliance + curvatures[d], Lanes(1.));
            system.right_hand(row) = select(is_free[d], -motion[d], Lanes(0.));
          }
      }
  }


  // E_i^T A_ij L_j
  void
  NewtonLanes::make_block(const unsigned int i, const unsigned int j)
  {
    const Face &row = faces[i], &column = faces[j];
    const auto is_row_free = row.free_directions(), is_column_free = column.free_directions();
    Lanes lifted[3][3]; // A_ij L_j
    for (unsigned int d = 0; d < 3; ++d)
      {
        const Lanes *const a = &A[3 * n * (3 * i + d) + 3 * j];
        lifted[d][2]         = column.slip_1 * a[1] + column.slip_2 * a[2];
        lifted[d][1]         = column.slip_1 * a[2] - column.slip_2 * a[1];
        lifted[d][0]         = a[0] + column.mu * lifted[d][2];
      }
    for (unsigned int e = 0; e < 3; ++e)
      {
        const Lanes block[] = {lifted[0][e],
                               row.slip_1 * lifted[2][e] - row.slip_2 * lifted[1][e],
                               row.slip_1 * lifted[1][e] + row.slip_2 * lifted[2][e]};
        for (unsigned int d = 0; d < 3; ++d)
          system(3 * i + d,
                 3 * j + e) = select(is_row_free[d] & is_column_free[e], block[d], Lanes(0.));
      }
  }


  void
  NewtonLanes::unpack(std::vector<Problem> &problems) const
  {
    for (unsigned int lane = 0; lane < problems.size(); ++lane)
      {
        const auto number      = [&](const Lanes &lanes) { return lanes.get(lane); };
        Problem &problem       = problems[lane];
        problem.is_solved      = solved.get(lane);
        problem.n_applications = static_cast<unsigned int>(number(n_applications));
        problem.residual       = number(final_residual);
        if (!problem.is_solved)
          continue;
        for (std::size_t i = 0; i < problem.t->size(); ++i)
          {
            const CoulombFace::Force force(
              {number(t[3 * i]), number(t[3 * i + 1]), number(t[3 * i + 2])});
            const double limit = problem.data->friction[i] * std::max(force[0], 0.);
            (*problem.t)[i]    = CoulombFace::project(force, limit); // what the tolerance left
          }
      }
  }
} // namespace akmon
