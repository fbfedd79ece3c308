#pragma once

#include <akmon/checkpoint/checkpoint_parameters.h>
#include <akmon/contact/contact_parameters.h>
#include <akmon/forces/external_forces.h>
#include <akmon/material/material.h>
#include <akmon/model/body.h>
#include <akmon/model/essential_conditions.h>
#include <akmon/model/partition.h>
#include <akmon/output/output_parameters.h>
#include <akmon/rigid/obstacle.h>
#include <akmon/time/step_control.h>

#include <deal.II/base/parameter_handler.h>

#include <ostream>
#include <string>
#include <vector>

namespace akmon
{
  /// Everything a parameter file says. Lists such as "Bodies/Names" name the subsections that
  /// describe the items.
  struct Case
  {
    std::string title;
    std::string output_directory;
    StepControl time;
    std::vector<Material> materials;
    std::vector<Body> bodies;
    std::vector<PrescribedMotion> prescribed_motions;
    std::vector<SurfaceLoad> surface_loads;
    BodyForce body_force;
    ContactSolver contact_solver;
    std::vector<SurfaceContact> contacts;
    std::vector<Obstacle> obstacles;
    std::vector<Probe> probes;
    OutputParameters output;
    CheckpointParameters checkpoint;
    PartitionParameters partition;
    std::string as_used;           ///< every parameter, in the form of a prm file
    std::vector<std::string> idle; ///< a line for each parameter that was set in vain

    /**
     * Read a prm file, then the overrides "Section/Sub/Key=value".
     * Throws InputError, with line or section, key, value and what is allowed, for unknown keys and
     * inadmissible values; the top level adds the file's name.
     */
    static Case
    read(const std::string &file, const std::vector<std::string> &overrides);

    /// Every parameter with default, allowed values and meaning, as Markdown; lists get one item
    /// "NAME".
    static void
    print_reference(std::ostream &out);
  };
} // namespace akmon
