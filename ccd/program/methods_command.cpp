#include <ccd/method.hpp>
#include <iostream>

#include "ccd/program/command.hpp"
#include "errbound/support/table.hpp"

namespace ccd::program {
namespace {

class methods final : public command {
  public:
    explicit methods(CLI::App& program)
        : command(program, "methods", "List all methods with their guarantees") {}

    exit_status run() override {
        errbound::support::table rows = {{"method", "promise", "source"}};
        for (const method_info& entry : ccd::methods())
            rows.push_back(
                {std::string(entry.name), std::string(entry.promise), std::string(entry.source)});
        std::cout << errbound::support::text_of(rows, 3);
        return done;
    }
};

}  // namespace

std::unique_ptr<command> methods_command(CLI::App& program) {
    return std::make_unique<methods>(program);
}

}  // namespace ccd::program
