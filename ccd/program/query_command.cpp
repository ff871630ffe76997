#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <iostream>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "ccd/program/command.hpp"
#include "ccd/program/options.hpp"
#include "ccd/program/query_results.hpp"
#include "errbound/support/output_file.hpp"
#include "errbound/support/progress_line.hpp"

namespace ccd::program {

namespace {

using errbound::support::usage_error;

class query final : public command {
  public:
    explicit query(CLI::App& program) : command(program, "query", "Decide stored queries") {
        files_.add_options(line_);
        add_range_options(line_, range_.first, range_.count,
                          "Skip the first N queries of each file",
                          "Decide at most N queries of each file; all by default");
        add_output(line_, "--verdicts", verdicts_,
                   "Write 0 or 1 per query (one method, one file); -: standard output");
        add_output(line_, "--toi", toi_,
                   "Write low,high per query: the first contact is between these adjacent\n"
                   "hexadecimal floats (0,0 at the start; equal if the time is a double); a line\n"
                   "- means no contact (method exact, one file); -: standard output");
        add_output(line_, "--json", json_, "Write the table as JSON; -: standard output");
    }

    exit_status run() override {
        errbound::support::require_one_standard_input("FILE", files_.paths);
        const device_choice device = device_.chosen();
        const time_request times = checked_times();
        const std::vector<ccd::method> methods = methods_on(device);
        for (const auto& [option, output] : {std::pair("--verdicts", &verdicts_), {"--toi", &toi_}})
            if (*output && (files_.paths.size() != 1 || methods.size() != 1))
                throw usage_error(std::string(option) + " has " +
                                  std::to_string(files_.paths.size()) + " files and " +
                                  std::to_string(methods.size()) +
                                  " methods; expected one FILE and one --method");
        errbound::support::require_good_outputs({verdicts_, toi_, json_}, files_.paths);
        // All files are read before anything is printed or written.
        write(decide_files(methods, device, times));
        return done;
    }

  private:
    time_request checked_times() const {
        time_request times{.verdicts = verdicts_.has_value(),
                           .times = toi_.has_value(),
                           .t_max = t_max_.value(1, 1)};
        if (separation_.was_given())
            times.distance = separation_.value(0, std::numeric_limits<double>::max());
        return times;
    }

    std::vector<ccd::method> methods_on(const device_choice& device) const {
        const bool all = !methods_.was_given();
        if (toi_ || t_max_.was_given() || separation_.was_given()) {
            if (!all && methods_.methods() != std::vector{method::exact})
                throw usage_error(
                    "--method is not exact; expected exact with --toi, --separation or --t-max");
            if (device.cuda && separation_.was_given())
                throw usage_error("--device is cuda; expected cpu with --separation");
            return {method::exact};
        }
        if (device.cuda && all) return methods_on_device();
        std::vector<ccd::method> methods = methods_.methods();
        if (device.cuda) std::ranges::for_each(methods, require_on_device);
        return methods;
    }

    std::vector<query_result> decide_files(const std::vector<ccd::method>& methods,
                                           const device_choice& device,
                                           const time_request& times) const {
        std::vector<query_result> results;
        constexpr double seconds = 0.02;
        errbound::support::progress_line progress;
        for (std::size_t i = 0; i < files_.paths.size(); ++i) {
            const std::string file = files_.paths[i].string();
            progress.show(i, files_.paths.size(), file);
            const io::query_file queries =
                io::read_queries(files_.paths[i], find_kind(files_.kind), files_.round, range_);
            for (const ccd::method m : methods)
                results.push_back(decide_queries(queries, file, m, device, times, seconds));
        }
        return results;
    }

    void write(const std::vector<query_result>& results) const {
        std::vector<errbound::support::output> files;
        if (verdicts_) {
            std::string lines;
            for (const char verdict : results.front().verdicts) lines.append({verdict, '\n'});
            files.push_back({*verdicts_, lines});
        }
        if (toi_) files.push_back({*toi_, results.front().times});
        if (json_) files.push_back({*json_, json_of_results(results)});
        errbound::support::write_whole(files);
        errbound::support::stream_for_people({verdicts_, toi_, json_}) << text_of_results(results);
    }

    query_files files_;
    io::file_range range_;
    std::optional<std::filesystem::path> verdicts_, toi_, json_;
    number_option separation_{line_, "--separation",
                              "Test for a distance of at most NUMBER instead of contact"};
    number_option t_max_{line_, "--t-max", "Test times from 0 to NUMBER instead of 1"};
    methods_option methods_{line_};
    device_options device_{line_};
};

}  // namespace

const command_maker query_command = make_command<query>;

}  // namespace ccd::program
