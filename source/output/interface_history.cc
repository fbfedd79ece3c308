#include <akmon/contact/bonds/bonds.h>
#include <akmon/output/interface_history.h>

#include <deal.II/base/mpi.h>

#include <algorithm>

namespace akmon
{
  using namespace dealii;

  namespace
  {
    template <typename Items, typename Value>
    double
    sum_over(const Items &items, const Value &value)
    {
      double sum = 0.;
      for (const auto &item : items)
        sum += value(item);
      return sum;
    }
  } // namespace


  InterfaceHistory::InterfaceHistory(const std::string &directory,
                                     const Contact &contact,
                                     const NodalState &state)
    : contact(contact)
    , state(state)
    , communicator(state.x.get_mpi_communicator())
    , file(directory + "/contact.csv", communicator)
    , interfaces(contact.names().size())
  {
    file.add_column("time");
    for (const auto &name : contact.names())
      {
        for (const char *const vector : {".normal_force_", ".friction_force_", ".moment_"})
          for (const char *const axis : {"x", "y", "z"})
            file.add_column(name + vector + axis);
        for (const char *const number : {".area",
                                         ".sticking_pairs",
                                         ".slipping_pairs",
                                         ".friction_dissipation",
                                         ".impact_dissipation",
                                         ".contact_energy",
                                         ".bond_energy",
                                         ".broken_area",
                                         ".max_pressure",
                                         ".max_penetration",
                                         ".max_penetration_rel"})
          file.add_column(name + number);
      }
  }


  void
  InterfaceHistory::observe(const ContactReport &report)
  {
    const auto before = contact.works(state.dx, &RigidBody::increment_before),
               after  = contact.works(state.dx_next, &RigidBody::increment_after);
    const auto stored = contact.stored_energies();
    // What springs take they store.
    const double taken = contact.stores_energy() ? 0. : 1.;
    for (unsigned int i = 0; i < interfaces.size(); ++i)
      {
        auto &interface = interfaces[i];
        const auto add  = [&](WorkLine &line, const double work_before, const double work_after) {
          if (state.step == 0)
            line.add_start(-work_before, -work_after);
          else
            line.add_level(-work_before, -work_after);
        };
        add(interface.friction, before[i].tangential, after[i].tangential);
        add(interface.impact,
            taken * before[i].normal + before[i].holding,
            taken * after[i].normal + after[i].holding);
        add(interface.bond, before[i].failing, after[i].failing);
        interface.stored_normal        = stored[i].normal;
        interface.stored_tangential    = stored[i].tangential;
        interface.penetration          = std::max(interface.penetration,
                                         report.interfaces[i].max_penetration);
        interface.penetration_relative = std::max(interface.penetration_relative,
                                                  report.interfaces[i].max_penetration_relative);
      }
  }


  double
  InterfaceHistory::friction_dissipation() const
  {
    return sum_over(interfaces, [](const Interface &i) { return i.friction_dissipation(); });
  }


  double
  InterfaceHistory::impact_dissipation() const
  {
    return sum_over(interfaces, [](const Interface &i) { return i.impact.value(); });
  }


  double
  InterfaceHistory::contact_energy() const
  {
    return sum_over(interfaces, [](const Interface &i) { return i.contact_energy(); });
  }


  double
  InterfaceHistory::bond_energy() const
  {
    return sum_over(interfaces, [](const Interface &i) { return i.bond.value(); });
  }


  void
  InterfaceHistory::write_row(const ContactReport &report)
  {
    if (interfaces.empty())
      return;
    const auto patches = contact.patches(state);
    const bool root    = Utilities::MPI::this_mpi_process(communicator) == 0; // all know the bonds
    std::vector<double> sums, maxima;
    for (unsigned int i = 0; i < interfaces.size(); ++i)
      {
        const auto &of_contact = report.interfaces[i];
        auto &interface        = interfaces[i];
        for (const auto &vector :
             {of_contact.normal_force, of_contact.friction_force, of_contact.moment})
          sums.insert(sums.end(), vector.begin_raw(), vector.end_raw());
        for (const double number : {patches[i].area,
                                    double(of_contact.sticking_pairs),
                                    double(of_contact.slipping_pairs),
                                    interface.friction_dissipation(),
                                    interface.impact.value(),
                                    interface.contact_energy(),
                                    interface.bond.value(),
                                    root ? contact.get_bonds().report(i).broken_area : 0.})
          sums.push_back(number);
        for (const double number :
             {patches[i].max_pressure, interface.penetration, interface.penetration_relative})
          maxima.push_back(number);
        interface.penetration = interface.penetration_relative = 0.;
      }
    Utilities::MPI::sum(sums, communicator, sums);
    Utilities::MPI::max(maxima, communicator, maxima);

    std::vector<double> row    = {state.time};
    const std::size_t n_sums   = sums.size() / interfaces.size(),
                      n_maxima = maxima.size() / interfaces.size();
    for (unsigned int i = 0; i < interfaces.size(); ++i)
      {
        row.insert(row.end(), sums.begin() + i * n_sums, sums.begin() + (i + 1) * n_sums);
        row.insert(row.end(), maxima.begin() + i * n_maxima, maxima.begin() + (i + 1) * n_maxima);
      }
    file.write_row(row);
  }


  void
  InterfaceHistory::save(CheckpointWriter &checkpoint)
  {
    std::vector<double> works, extremes;
    for (const auto &interface : interfaces)
      {
        for (const WorkLine *const line : {&interface.friction, &interface.impact, &interface.bond})
          for (const double part : line->parts())
            works.push_back(part);
        extremes.push_back(Utilities::MPI::max(interface.penetration, communicator));
        extremes.push_back(Utilities::MPI::max(interface.penetration_relative, communicator));
      }
    checkpoint.part_of_rank("interface_works", works);
    checkpoint.numbers("interface_penetrations", extremes);
    checkpoint.integer("interface_history_size", file.secure());
  }


  void
  InterfaceHistory::restore(const CheckpointReader &checkpoint)
  {
    size = checkpoint.integer("interface_history_size");
    file.check_beginning(size);
    const auto works    = checkpoint.sum_of_rank("interface_works", communicator);
    const auto extremes = checkpoint.numbers("interface_penetrations");
    for (unsigned int i = 0; i < interfaces.size(); ++i)
      {
        interfaces[i].friction.continue_from({{works.at(6 * i), works.at(6 * i + 1)}});
        interfaces[i].impact.continue_from({{works.at(6 * i + 2), works.at(6 * i + 3)}});
        interfaces[i].bond.continue_from({{works.at(6 * i + 4), works.at(6 * i + 5)}});
        interfaces[i].penetration          = extremes.at(2 * i);
        interfaces[i].penetration_relative = extremes.at(2 * i + 1);
      }
  }


  void
  InterfaceHistory::continue_output()
  {
    file.continue_behind(size);
  }
} // namespace akmon
