#pragma once

#include <akmon/checkpoint/checkpoint.h>
#include <akmon/contact/contact.h>
#include <akmon/output/energy_balance.h>
#include <akmon/output/history.h>

#include <string>
#include <vector>

namespace akmon
{
  /**
   * What happens at every contact and obstacle: contact.csv, a row whenever history.csv has one.
   * Keeps the works of contact forces, interface by interface. Without interfaces there is no file.
   */
  class InterfaceHistory
  {
  public:
    InterfaceHistory(const std::string &directory, const Contact &contact, const NodalState &state);

    /// Account for a time level.
    void
    observe(const ContactReport &report);

    /// Dissipation on this rank so far, of all interfaces; energy.
    double
    friction_dissipation() const;
    double
    impact_dissipation() const;

    /// Elastic energy of penalty springs, and what bonds took, on this rank; energy.
    double
    contact_energy() const;
    double
    bond_energy() const;

    /// The row of a level that was observed (collective).
    void
    write_row(const ContactReport &report);

    /// Works, extremes and how far the file has come (collective).
    void
    save(CheckpointWriter &checkpoint);

    /// Take them back. Throws InputError if the file there does not fit (collective).
    void
    restore(const CheckpointReader &checkpoint);

    /// Make the file what it was at the checkpoint (collective).
    void
    continue_output();

  private:
    struct Interface
    {
      WorkLine friction, impact, bond;
      double stored_normal = 0., stored_tangential = 0.;  ///< in penalty springs; energy
      double penetration = 0., penetration_relative = 0.; ///< since the last row

      double
      friction_dissipation() const
      {
        return friction.value() - stored_tangential;
      }

      /// Elastic energy of penalty springs.
      double
      contact_energy() const
      {
        return stored_normal + stored_tangential;
      }
    };

    const Contact &contact;
    const NodalState &state;
    const MPI_Comm communicator;
    History file;
    std::vector<Interface> interfaces;
    std::uint64_t size = 0; ///< of the file at the checkpoint the run goes on from; bytes
  };
} // namespace akmon
