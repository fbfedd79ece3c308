#include <akmon/output/output_parameters.h>
#include <akmon/parameters.h>

namespace akmon
{
  using dealii::Patterns::Anything;
  using dealii::Patterns::Double;
  using dealii::Patterns::Integer;
  using dealii::Patterns::Selection;

  void
  OutputParameters::declare(dealii::ParameterHandler &prm)
  {
    prm.declare_entry("Fields interval",
                      "0",
                      Double(0.),
                      "Time between field outputs (time; 0: none)");
    prm.declare_entry("Fields steps", "0", Integer(0), "Steps between field outputs (0: none)");
    prm.declare_entry("History interval",
                      "0",
                      Double(0.),
                      "Time between rows of history.csv (time; 0: none)");
    prm.declare_entry("History steps",
                      "1",
                      Integer(0),
                      "Steps between rows of history.csv (0: none)");
    prm.declare_entry("Configuration",
                      "deformed",
                      Selection("deformed|reference"),
                      "Node positions in the field files");
    prm.declare_entry(
      "Energy error bound",
      "0.05",
      Double(0.),
      "The run stops when the energy error, relative to the largest energy so far, is "
      "beyond this; looked at with every history row and at least every 16 steps (dimensionless)");
    prm.declare_entry(
      "Hourglass energy bound",
      "0.1",
      Double(0.),
      "The run stops when the work against the hourglass control of one-point cells, "
      "relative to the largest energy so far, is beyond this (dimensionless)");
    prm.declare_entry(
      "Penetration bound",
      "0.25",
      Double(0.),
      "The run stops when a penetration over the cell size is beyond this at a history "
      "row: contact was lost; with penalty contact a warning (dimensionless)");
  }


  void
  OutputParameters::parse(dealii::ParameterHandler &prm)
  {
    fields.interval        = prm.get_double("Fields interval");
    fields.steps           = prm.get_integer("Fields steps");
    history.interval       = prm.get_double("History interval");
    history.steps          = prm.get_integer("History steps");
    deformed               = prm.get("Configuration") == "deformed";
    energy_error_bound     = prm.get_double("Energy error bound");
    hourglass_energy_bound = prm.get_double("Hourglass energy bound");
    penetration_bound      = prm.get_double("Penetration bound");
  }


  void
  Probe::declare(dealii::ParameterHandler &prm)
  {
    prm.declare_entry("Body", "", Anything(), "Name of the body the probe sits on");
    declare_vector(prm,
                   "Point",
                   "0, 0, 0",
                   "Initial position; the probe is the body's closest node (length)");
  }


  void
  Probe::parse(dealii::ParameterHandler &prm, const std::string &section)
  {
    body  = prm.get("Body");
    point = dealii::Point<3>(get_vector(prm, section, "Point"));
    if (body.empty())
      throw InputError(section, "Body", "(none)", "allowed are the names in Bodies/Names");
  }
} // namespace akmon
