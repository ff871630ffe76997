// What a run leaves in a folder: a PLY file a frame, a table of all frames, and where to go on.
//
//   frames/00000.ply ...   positions, in doubles, bit for bit as `exact` was asked about them
//   frames.csv             a row a frame: times, contacts, energies
//   state                  of the last frame, replaced whole
//   run.txt                the scene, method and options, which must be the same to go on
#pragma once

#include <filesystem>
#include <string>

#include "examples/simulation/simulation.hpp"

namespace simulation {

class run_folder {
  public:
    /// Makes the folder, or goes on with the one that is there. Throws file_error
    /// if it holds another run (`description` differs) or what it holds cannot be read.
    run_folder(std::filesystem::path folder, const std::string& description);

    /// Takes the run to the last frame that is stored; nothing if there is none.
    void restore(simulation_run& run) const;
    /// Stores the frame that the run is at.
    void store(const simulation_run& run, const frame_record& record);
    /// Stores what the solver proposed for that frame: proposals/NNNNN.ply.
    void store_proposal(const simulation_run& run) const;
    /// Stores the start.
    void store_start(const simulation_run& run);

    const std::filesystem::path& path() const { return folder_; }

  private:
    void write_frame(const char* in, const simulation_run& run, const rows& positions) const;

    std::filesystem::path folder_;
    bool is_new_;
};

/// The heading of frames.csv, and a row of it.
std::string csv_heading();
std::string csv_row(const frame_record& record);

}  // namespace simulation
