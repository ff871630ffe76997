// A study: what the journal has, then rounds.
#include "errbound/study/study.hpp"

#include <errbound/support/error.hpp>
#include <iostream>
#include <stdexcept>
#include <utility>

#include "errbound/support/signals.hpp"

namespace errbound::study {

study::study(MPI_Comm comm, subject what, std::optional<std::filesystem::path> journal)
    : comm_(comm), what_(std::move(what)), path_(std::move(journal)) {
    MPI_Comm_rank(comm, &rank_);
    on_root(comm_, [this] { open(); });
}

void study::open() {
    results_.resize(what_.chunks);
    is_done_.resize(what_.chunks);
    if (!path_) return;
    journal_ = std::make_unique<journal>(*path_, what_.identity);
    for (chunk_result& found : journal_->take_results()) {
        if (found.first >= what_.chunks)
            throw support::file_error(path_->string() + ": found chunk " +
                                      std::to_string(found.first) + ", expected fewer than " +
                                      std::to_string(what_.chunks));
        take(std::move(found));
    }
}

void study::take(chunk_result found) {
    if (!is_done_[found.first]) ++done_;
    is_done_[found.first] = true;
    results_[found.first] = std::move(found.second);
}

bool study::complete(const progress& show) {
    std::optional<support::awaited_signals> signals;
    static const std::atomic<int> never = 0;
    if (path_)
        signals.emplace(rank_ > 0
                            ? std::string()
                            : what_.program + ": asked to end; what is done is in " +
                                  path_->string() + ", and the same command goes on from there\n");
    std::vector<std::uint64_t> left;
    for (std::uint64_t c = 0; c < is_done_.size(); ++c)
        if (!is_done_[c]) left.push_back(c);
    const auto keep = [&](std::vector<chunk_result> found) {
        if (journal_) journal_->append(found);
        for (chunk_result& one : found) take(std::move(one));
        if (show) show(done_, results_.size());
    };
    ending end{};
    try {
        end = in_rounds(comm_, std::move(left), what_.work, keep,
                        signals ? signals->arrived() : never);
    } catch (const std::runtime_error&) {
        if (journal_ && done_ == 0) journal_->remove();  // of what cannot be studied
        throw;
    }
    if (end == ending::done) return true;
    if (rank_ == 0)
        std::cerr << what_.program << ": ended with " << done_ << " of " << results_.size()
                  << " chunks done\n";
    return false;
}

int study::conclude(const std::function<int()>& write) {
    int status = 0;
    on_root(comm_, [&] {
        status = write();
        if (journal_) journal_->remove();
    });
    MPI_Bcast(&status, 1, MPI_INT, 0, comm_);
    return status;
}

}  // namespace errbound::study
