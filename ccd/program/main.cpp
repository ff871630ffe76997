// The program `ccd`: reads the command line. Exit status 0 done, 1 bad input (or a method that
// broke its promise, in `ccd stress` and `ccd report`, or a CUDA device that is missing or failed),
// 2 bad usage.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <exception>
#include <iostream>
#include <string>

#include "ccd/program/commands.hpp"
#include "ccd/report/report.hpp"
#include "errbound/support/command_line.hpp"
#include "errbound/support/error.hpp"
#include "errbound/support/table.hpp"

namespace ccd::program {
namespace {

enum exit_status { done = 0, bad_input = 1, broken_promise = 1, bad_usage = 2 };

ccd::method method_named(const std::string& name) {
    if (const std::optional<ccd::method> method = find_method(name)) return *method;
    std::string known;
    for (const method_info& entry : methods()) {
        known += (known.empty() ? "" : ", ") + std::string(entry.name);
    }
    throw usage_error("--method: found '" + name + "', expected one of " + known);
}

ccd::instruction_set instruction_set_named(const std::string& name) {
    std::string known;
    for (const ccd::instruction_set set : instruction_sets()) {
        if (ccd::name(set) == name) return set;
        known += (known.empty() ? "" : ", ") + std::string(ccd::name(set));
    }
    throw usage_error("--instruction-set: found '" + name + "', expected one of " + known +
                      " (what this build holds and this machine runs)");
}

device_choice device_named(const std::string& device, const std::string& precision) {
    if (device == "cpu") {
        if (!precision.empty())
            throw usage_error("--precision: found --device cpu, expected --device cuda");
        return {};
    }
    require_device();
    return {true, precision == "float32" ? cuda::precision::float32 : cuda::precision::float64};
}

/// Only some methods run on devices.
void require_on_device(ccd::method m) {
    const std::vector<ccd::method> possible = methods_on_device();
    if (std::ranges::find(possible, m) != possible.end()) return;
    std::string known;
    for (const ccd::method p : possible)
        known += (known.empty() ? "" : ", ") + std::string(info(p).name);
    throw usage_error("--method: found '" + std::string(info(m).name) +
                      "' with --device cuda, expected one of " + known);
}

const stress::family* family_named(const std::string& name) {
    std::string known;
    for (const stress::family& entry : stress::families()) {
        if (entry.name == name) return &entry;
        known += (known.empty() ? "" : ", ") + std::string(entry.name);
    }
    throw usage_error("--family: found '" + name + "', expected one of " + known);
}

/// The methods of a list M[,M...], or all.
std::vector<ccd::method> methods_named(const std::string& list, bool all) {
    if (!all) return all_named(list, method_named);
    std::vector<ccd::method> result;
    for (const method_info& entry : methods()) result.push_back(entry.method);
    return result;
}

/// The families of a list F[,F...], or all.
std::vector<const stress::family*> families_named(const std::string& list, bool all) {
    if (!all) return all_named(list, family_named);
    std::vector<const stress::family*> result;
    for (const stress::family& entry : stress::families()) result.push_back(&entry);
    return result;
}

struct command_line {
    CLI::App app{
        "Exact continuous collision detection.\n"
        "Exit status: 0 done, 1 bad input, 2 bad usage; of stress and report also 1: a promise was "
        "broken.",
        "ccd"};
    query_arguments query;
    step_arguments step;
    stress_arguments stress;
    report_arguments report;
    std::string query_methods, query_kind, step_method = "exact", step_set;
    std::string device = "cpu", precision;
    std::string stress_methods, stress_families, report_methods;
    bool stress_quick = false;
    std::size_t stress_queries = 1000;
    CLI::App* query_command = nullptr;
    CLI::App* step_command = nullptr;
    CLI::App* stress_command = nullptr;
    CLI::App* report_command = nullptr;
    CLI::App* methods_command = nullptr;

    void add_device_options(CLI::App& command) {
        command.add_option("--device", device, "Where to decide: cpu, else cuda")
            ->check(CLI::IsMember({"cpu", "cuda"}))
            ->capture_default_str();
        command
            .add_option("--precision", precision,
                        "With --device cuda: what methods compute in first, float64 (the default)\n"
                        "or float32; what floats cannot tell is decided in doubles")
            ->check(CLI::IsMember({"float64", "float32"}));
    }

    command_line() {
        app.require_subcommand(1);
        app.set_version_flag("--version", std::string("ccd ") + ERRBOUND_VERSION);

        query_command = app.add_subcommand("query", "Decide stored queries");
        query_command
            ->add_option(
                "FILE", query.files,
                "CSV, 8 rows per query: v f0 f1 f2 (or a0 a1 b0 b1) at t = 0, then at t = 1; a row "
                "is\n"
                "xnum,xden,ynum,yden,znum,zden or x,y,z, then optionally the truth, 0 or 1")
            ->required();
        query_command->add_option("--method", query_methods, "Methods M[,M...], else all")
            ->type_name("M[,M...]");
        query_command
            ->add_option("--kind", query_kind,
                         "Kind of query; else the path tells (vertex-face or vf, edge-edge or ee)")
            ->check(CLI::IsMember(io::kind_names()));
        query_command->add_flag(
            "--round", query.round,
            "Round rationals and hexadecimal floats that no double equals, instead of refusing\n"
            "them (decimals always mean the nearest double)");
        query_command
            ->add_option("--verdicts", query.verdicts,
                         "Write 0 or 1 per query (one method, one file)")
            ->type_name("OUT");
        query_command->add_option("--json", query.json, "Write the table as JSON")
            ->type_name("OUT");
        add_device_options(*query_command);

        step_command = app.add_subcommand("step", "One step of a mesh: the colliding pairs");
        step_command->add_option("FRAME0", step.before, "PLY or OBJ")->required();
        step_command->add_option("FRAME1", step.after, "PLY or OBJ, same topology")->required();
        step_command->add_option("--method", step_method, "The method, else exact")->type_name("M");
        step_command
            ->add_option("--pairs", step.pairs,
                         "Write lines vf,v,f0,f1,f2 and ee,a0,a1,b0,b1, vertex indices")
            ->type_name("OUT");
        step_command->add_option("--threads", step.threads, "Threads; 0: one per core")
            ->check(CLI::Range(0, 4096));
        step_command
            ->add_option("--instruction-set", step_set,
                         "For exact: baseline, avx2 or avx512, else the strongest that runs here")
            ->type_name("SET");
        step_command->add_flag("--explain", step.explain,
                               "Tell what each stage of exact settled, at what cost, and what was\n"
                               "left out");
        step_command->add_option("--json", step.json, "Write counts and seconds as JSON")
            ->type_name("OUT");
        add_device_options(*step_command);

        stress_command =
            app.add_subcommand("stress",
                               "Every method on stiff and extreme queries, family by family, each "
                               "with a knob that is\n"
                               "swept over its whole range; truth by unbounded integers");
        stress_command->add_flag("--quick", stress_quick, "About a minute instead of ten");
        stress_command->add_option("--method", stress_methods, "Methods M[,M...], else all")
            ->type_name("M[,M...]");
        stress_command->add_option("--family", stress_families, "Families F[,F...], else all")
            ->type_name("F[,F...]");
        stress_command
            ->add_option(
                "--queries", stress_queries,
                "So many of each family, kind and value of the knob; fewer where the truth\n"
                "takes tenths of a second")
            ->check(CLI::Range(1, 1000000));
        stress_command->add_option("--seed", stress.plan.seed, "Same seed, same queries")
            ->capture_default_str();
        stress_command
            ->add_option("--threads", stress.plan.threads,
                         "Threads that find the truth; 0: one per core. Methods are timed on one")
            ->check(CLI::Range(0, 4096));
        stress_command
            ->add_option("--out", stress.out,
                         "Write DIR/stress.csv, a row per cell, and DIR/stress.md, the table")
            ->type_name("DIR");
        stress_command
            ->add_option("--json", stress.json,
                         "Write the cells as JSON; a knob of null is exactly zero (CSV: -inf)")
            ->type_name("OUT");

        report_command = app.add_subcommand(
            "report",
            "Error against run time: tables and pictures of all methods and bound rules.\n"
            "A stopped report goes on where it was");
        report_command->add_option(
            "DATA", report.data,
            "Folders with stored queries (CSV; kind from the path) and scenes (folders of two\n"
            "meshes), looked through with all they hold; else the bundled scene and queries that\n"
            "the program makes itself");
        report_command->add_option("--out", report.out, "The report's folder, else out/report")
            ->type_name("DIR");
        report_command->add_flag("--quick", report.quick, "Fewer queries are timed");
        report_command->add_option("--method", report_methods, "Methods M[,M...], else all")
            ->type_name("M[,M...]");
        report_command
            ->add_option("--sections", report.sections,
                         "Only these: methods, times, bounds, tightness (needs a build with\n"
                         "MPFR), stress")
            ->type_name("S[,S...]")
            ->delimiter(',')
            ->check(CLI::IsMember(std::vector<std::string>(std::begin(report::section_names),
                                                           std::end(report::section_names))));
        report_command
            ->add_option("--threads", report.threads,
                         "Threads that count errors; 0: one per core (times are taken on one)")
            ->check(CLI::Range(0, 4096));
        report_command
            ->add_option("--commit", report.commit,
                         "To be told in the report, else that of the configured build")
            ->type_name("TEXT");

        methods_command =
            app.add_subcommand("methods", "What methods there are and what each promises");
    }

    exit_status run() {
        if (query_command->parsed()) {
            query.device = device_named(device, precision);
            const bool all = query_command->count("--method") == 0;
            query.methods =
                all && query.device.cuda ? methods_on_device() : methods_named(query_methods, all);
            if (query.device.cuda)
                for (const ccd::method m : query.methods) require_on_device(m);
            query.kind = find_kind(query_kind);
            if (query.verdicts && (query.files.size() != 1 || query.methods.size() != 1)) {
                throw usage_error("--verdicts: found " + std::to_string(query.files.size()) +
                                  " files and " + std::to_string(query.methods.size()) +
                                  " methods, expected one FILE and one --method");
            }
            require_separate({query.verdicts, query.json}, query.files);
            run_query(query);
        } else if (step_command->parsed()) {
            step.method = method_named(step_method);
            if (step_command->count("--instruction-set") > 0)
                step.set = instruction_set_named(step_set);
            if (step.method != method::exact && (step.explain || step.set))
                throw usage_error("--explain and --instruction-set: found --method " + step_method +
                                  ", expected exact, which alone has stages");
            step.device = device_named(device, precision);
            if (step.device.cuda) {
                require_on_device(step.method);
                if (step.explain || step.set || step_command->count("--threads") > 0)
                    throw usage_error(
                        "--explain, --instruction-set and --threads: found --device cuda, expected "
                        "--device cpu");
            }
            require_separate({step.pairs, step.json}, {step.before, step.after});
            run_step(step);
        } else if (stress_command->parsed()) {
            for (const ccd::method m :
                 methods_named(stress_methods, stress_command->count("--method") == 0))
                stress.plan.subjects.push_back(stress::subject_of(info(m)));
            stress.plan.families =
                families_named(stress_families, stress_command->count("--family") == 0);
            const bool few = stress_quick && stress_command->count("--queries") == 0;
            stress.plan.queries = few ? 100 : stress_queries;
            stress.plan.seconds = stress_quick ? 0.002 : 0.02;
            if (stress.json && stress.out)
                require_separate({stress.json},
                                 {*stress.out / "stress.csv", *stress.out / "stress.md"});
            if (!run_stress(stress)) return broken_promise;
        } else if (report_command->parsed()) {
            report.methods = methods_named(report_methods, report_command->count("--method") == 0);
            if (!run_report(report)) return broken_promise;
        } else if (methods_command->parsed()) {
            run_methods();
        }
        return done;
    }
};

int main_with_status(int argc, char** argv) {
    command_line line;
    exit_status status = done;
    try {
        line.app.parse(argc, argv);
        status = line.run();
    } catch (const CLI::ParseError& error) {
        if (line.app.exit(error) != 0) return bad_usage;
    } catch (const usage_error& error) {
        std::cerr << "ccd: " << error.what() << '\n';
        return bad_usage;
    } catch (const io::file_error& error) {
        std::cerr << "ccd: " << error.what() << '\n';
        return bad_input;
    } catch (const device_error& error) {
        std::cerr << "ccd: " << error.what() << '\n';
        return bad_input;
    } catch (const std::bad_alloc&) {
        std::cerr << "ccd: out of memory\n";
        return bad_input;
    }
    if (!std::cout.flush()) {
        std::cerr << "ccd: standard output cannot be written\n";
        return bad_input;
    }
    return status;
}

}  // namespace

void run_methods() {
    table rows = {{"method", "promise", "source"}};
    for (const method_info& entry : methods()) {
        rows.push_back(
            {std::string(entry.name), std::string(entry.promise), std::string(entry.source)});
    }
    std::cout << text_of(rows, 3);
}

}  // namespace ccd::program

int main(int argc, char** argv) {
    return ccd::program::main_with_status(argc, argv);
}
