// The output folder of a run:
//
//   frames/00000.ply ...   positions, in doubles, bit for bit those that `exact` tested
//   frames.csv             a row per frame: times, contacts, energies
//   state                  the last frame, replaced as a whole, with a checksum
//   run.txt                scene, method and options; a run continues only with equal ones
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "examples/simulation/simulation.hpp"

namespace simulation {

/// A lock of a folder, held by at most one process.
class folder_lock {
  public:
    /// Throws file_error if another process holds it.
    explicit folder_lock(const std::filesystem::path& folder);
    folder_lock(const folder_lock&) = delete;
    folder_lock& operator=(const folder_lock&) = delete;
    ~folder_lock();

  private:
    int descriptor_;
};

class run_folder {
  public:
    /// Makes the folder, or continues its run. Throws file_error if `description` differs, another
    /// process uses the folder, or it cannot be read.
    run_folder(std::filesystem::path folder, const std::string& description);

    /// Restores the last stored frame, if there is one. Throws file_error if the state is damaged,
    /// or the frame or a row of the table belongs to another run.
    void restore(simulation_run& run) const;
    void store(const simulation_run& run, const frame_record& record);
    /// Stores the positions that the solver proposed: proposals/NNNNN.ply.
    void store_proposal(const simulation_run& run) const;
    void store_start(const simulation_run& run);

    const std::filesystem::path& path() const { return folder_; }

  private:
    void write_frame(const char* in, const simulation_run& run, const rows& positions) const;

    std::filesystem::path frame_file(const char* in, int frame) const;

    std::filesystem::path folder_;
    std::optional<folder_lock> lock_;
    bool is_new_ = true;
};

std::string csv_heading();
std::string csv_row(const frame_record& record);

}  // namespace simulation
