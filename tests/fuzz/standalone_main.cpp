// Runs a fuzz target without libFuzzer: the corpus, then deterministic mutations of it.
// Usage: FUZZ_TARGET ITERATIONS CORPUS... (files, or directories of files).
#include <algorithm>
#include <charconv>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <iterator>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);
/// Most targets do not define it.
extern "C" __attribute__((weak)) std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data,
                                                                     std::size_t size,
                                                                     std::size_t max_size,
                                                                     unsigned seed);

namespace {

namespace fs = std::filesystem;

/// Tokens of the formats, which random bytes would rarely hit.
const std::vector<std::string> tokens = {"nan",
                                         "inf",
                                         "-0",
                                         "1e999",
                                         "1e-999",
                                         "0x1p-1074",
                                         "0x1.8p3",
                                         "0x1p99999",
                                         "18446744073709551616",
                                         "-1",
                                         "4294967295",
                                         "999999999999999",
                                         "\n",
                                         "\r\n",
                                         ",",
                                         " ",
                                         "/",
                                         "//",
                                         "#",
                                         "[",
                                         "]",
                                         "true",
                                         "false",
                                         "null",
                                         "element vertex 4294967296\n",
                                         "property list uint int extra\n",
                                         "property list char int extra\n",
                                         "property double w\n",
                                         "format ascii 1.0\n",
                                         "format binary_big_endian 1.0\n",
                                         "end_header\n",
                                         std::string(400, '9'),
                                         std::string(5000, '1')};

class mutator {
  public:
    explicit mutator(const std::vector<std::string>& corpus) : corpus_(corpus) {}

    std::string next() {
        std::string text = corpus_[below(corpus_.size())];
        if (LLVMFuzzerCustomMutator != nullptr) return mutated_by_target(text);
        for (std::size_t changes = 1 + below(4); changes > 0; --changes) change(text);
        return text;
    }

  private:
    std::size_t below(std::size_t end) { return static_cast<std::size_t>(random_() % end); }

    /// The target may lengthen texts to 4096 bytes, as under libFuzzer.
    std::string mutated_by_target(std::string text) {
        constexpr std::size_t longest = 4096;
        const std::size_t size = text.size();
        text.resize(std::max(size, longest));
        text.resize(LLVMFuzzerCustomMutator(reinterpret_cast<std::uint8_t*>(text.data()), size,
                                            text.size(), static_cast<unsigned>(random_())));
        return text;
    }

    std::string piece(const std::string& text) {
        const std::size_t begin = below(text.size() + 1);
        return text.substr(begin, below(64) + 1);
    }

    void change(std::string& text) {
        const std::size_t at = below(text.size() + 1);
        switch (below(6)) {
            case 0:
                if (at < text.size()) text[at] = static_cast<char>(below(256));
                break;
            case 1:
                if (at < text.size()) text[at] = static_cast<char>(text[at] ^ (1 << below(8)));
                break;
            case 2:
                text.erase(at, 1 + below(16));
                break;
            case 3:
                text.insert(at, tokens[below(tokens.size())]);
                break;
            case 4:
                text.insert(at, piece(corpus_[below(corpus_.size())]));
                break;
            default:
                text.resize(at);
        }
    }

    const std::vector<std::string>& corpus_;
    std::mt19937_64 random_{20240601};
};

void run(const std::string& text) {
    // An allocation of the exact size, so that sanitizers detect reads past the end.
    const std::vector<std::uint8_t> bytes(text.begin(), text.end());
    LLVMFuzzerTestOneInput(bytes.data(), bytes.size());
}

void add_file(std::vector<std::string>& corpus, const fs::path& path) {
    std::ifstream in(path, std::ios::binary);
    if (!in) throw std::runtime_error(path.string() + ": cannot be read");
    corpus.emplace_back(std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>());
}

}  // namespace

int main(int argc, char** argv) {
    std::size_t iterations = 0;
    const char* const end = argc > 1 ? argv[1] + std::strlen(argv[1]) : nullptr;
    if (argc < 2 || std::from_chars(argv[1], end, iterations).ptr != end) {
        std::cerr << "usage: " << argv[0] << " ITERATIONS [CORPUS...]\n";
        return 2;
    }
    try {
        std::vector<std::string> corpus = {""};
        for (int i = 2; i < argc; ++i) {
            if (!fs::is_directory(argv[i])) {
                add_file(corpus, argv[i]);
                continue;
            }
            std::vector<fs::path> files(fs::directory_iterator(argv[i]), fs::directory_iterator{});
            std::sort(files.begin(), files.end());
            for (const fs::path& file : files) add_file(corpus, file);
        }
        for (const std::string& text : corpus) run(text);
        mutator mutations(corpus);
        for (std::size_t i = 0; i < iterations; ++i) run(mutations.next());
        std::cout << corpus.size() << " corpus texts and " << iterations << " mutations\n";
    } catch (const std::exception& error) {
        std::cerr << argv[0] << ": " << error.what() << '\n';
        return 1;
    }
    return 0;
}
