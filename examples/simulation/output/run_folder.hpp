// What a run leaves in a folder: a PLY file a frame, a table of all frames, and where to go on.
//
//   frames/00000.ply ...   positions, in doubles, bit for bit as `exact` was asked about them
//   frames.csv             a row a frame: times, contacts, energies
//   state                  of the last frame, replaced whole, with a checksum
//   run.txt                the scene, method and options, which must be the same to go on
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "examples/simulation/simulation.hpp"

namespace simulation {

/// While it lives no other process has one of the same folder.
class folder_lock {
  public:
    /// Throws file_error if another process has one.
    explicit folder_lock(const std::filesystem::path& folder);
    folder_lock(const folder_lock&) = delete;
    folder_lock& operator=(const folder_lock&) = delete;
    ~folder_lock();

  private:
    int descriptor_;
};

class run_folder {
  public:
    /// Makes the folder, or goes on with the one that is there. Throws file_error if it holds
    /// another run (`description` differs), a process runs there, or it cannot be read.
    run_folder(std::filesystem::path folder, const std::string& description);

    /// Takes the run to the last frame that is stored; nothing if there is none. Throws file_error
    /// if the state is damaged, or that frame or a row of the table is not the run's.
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

    std::filesystem::path frame_file(const char* in, int frame) const;

    std::filesystem::path folder_;
    std::optional<folder_lock> lock_;
    bool is_new_ = true;
};

/// The heading of frames.csv, and a row of it.
std::string csv_heading();
std::string csv_row(const frame_record& record);

}  // namespace simulation
