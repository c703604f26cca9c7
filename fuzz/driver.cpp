// SPDX-License-Identifier: Apache-2.0
// What libFuzzer is to a target where the compiler has none: plays the kept inputs, then changes
// them at random for some seconds. It does not see which branches an input reaches, so it finds
// less; it runs wherever the tests run, under their sanitizers, and always the same way.
//
//   NAME CORPUS_FOLDER [INPUT]...     only the inputs, where there are some
//
// EYRIE_FUZZ_SECONDS: how long [10; 1 without the address sanitizer]. EYRIE_FUZZ_SEED: another
// order [1]. An input on which the target dies, takes more than EYRIE_FUZZ_LIMIT_SECONDS of
// processor time [1; 5 with the sanitizer] or 256 MiB more than before is left in NAME.crash.
#include <algorithm>
#include <array>
#include <chrono>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <string>
#include <vector>

#include <fcntl.h>
#include <sys/resource.h>
#include <sys/time.h>
#include <unistd.h>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

namespace {

namespace fs = std::filesystem;
using Input = std::vector<std::uint8_t>;
using Clock = std::chrono::steady_clock;

constexpr std::size_t kMaxBytes = 64 * 1024;
#ifdef __SANITIZE_ADDRESS__
constexpr int kUsualSeconds = 10;
constexpr int kUsualLimit = 5;  // everything takes some times longer
#else
constexpr int kUsualSeconds = 1;  // less is seen, and the tests run with sanitizers, too
constexpr int kUsualLimit = 1;
#endif
constexpr long kMaxGrowthKilobytes = 256 * 1024;

// What the signal handler needs, which may touch nothing else.
const Input* running = nullptr;
std::array<char, 4096> crashFile{};

void keepInput(int signal) {
    const int file = open(crashFile.data(), O_WRONLY | O_CREAT | O_TRUNC, 0644);
    if (running != nullptr && file >= 0 && write(file, running->data(), running->size()) >= 0)
        close(file);
    std::signal(signal, SIG_DFL);
    std::raise(signal);
}

int number(const char* name, int otherwise) {
    const char* text = std::getenv(name);
    return text == nullptr ? otherwise : std::atoi(text);
}

Input read(const fs::path& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

rusage used() {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return usage;
}

double processorSeconds(const rusage& usage) {
    return static_cast<double>(usage.ru_utime.tv_sec + usage.ru_stime.tv_sec) +
           static_cast<double>(usage.ru_utime.tv_usec + usage.ru_stime.tv_usec) * 1e-6;
}

double slowest = 0;  // seconds of processor time

/// SIGPROF after so many seconds of processor time, which a loaded machine does not take away.
void limitProcessorTime(int seconds) {
    itimerval limit{};
    limit.it_value.tv_sec = seconds;
    setitimer(ITIMER_PROF, &limit, nullptr);
}

/// Dies by a signal, like the target, where it is too slow or too large.
void play(const Input& input) {
    static const int kLimit = number("EYRIE_FUZZ_LIMIT_SECONDS", kUsualLimit);
    const rusage before = used();
    running = &input;
    limitProcessorTime(kLimit);
    // A copy of its very size: reading past the end is seen.
    const Input copy(input);
    LLVMFuzzerTestOneInput(copy.data(), copy.size());
    limitProcessorTime(0);
    const rusage after = used();
    slowest = std::max(slowest, processorSeconds(after) - processorSeconds(before));
    if (after.ru_maxrss - before.ru_maxrss > kMaxGrowthKilobytes) {
        std::fprintf(stderr, "more than 256 MiB for %zu bytes\n", input.size());
        std::abort();
    }
}

class Mutator {
public:
    Mutator(const std::vector<Input>& corpus, unsigned seed) : corpus_(corpus), random_(seed) {}

    Input next() {
        Input input = corpus_[below(corpus_.size())];
        for (std::size_t times = 1 + below(6); times > 0; --times) change(input);
        if (input.size() > kMaxBytes)
            input.resize(kMaxBytes);
        return input;
    }

private:
    std::size_t below(std::size_t end) { return end == 0 ? 0 : random_() % end; }

    void change(Input& input) {
        const std::size_t at = below(input.size());
        switch (input.empty() ? 5 : below(9)) {
            case 0:
                input[at] ^= static_cast<std::uint8_t>(1U << below(8));
                break;
            case 1:
                input[at] = static_cast<std::uint8_t>(random_());
                break;
            case 2: {  // a number at the edge of what its bytes hold
                static constexpr std::array<std::uint8_t, 5> kEdges{0, 1, 0x7f, 0x80, 0xff};
                const std::uint8_t edge = kEdges[below(kEdges.size())];
                for (std::size_t k = at; k < std::min(input.size(), at + (1U << below(4))); ++k)
                    input[k] = edge;
                break;
            }
            case 3:
                input.resize(at);
                break;
            case 4:
                input.erase(input.begin() + offset(at),
                            input.begin() + offset(std::min(input.size(), at + 1 + below(16))));
                break;
            case 5: {  // a piece of another
                const Input& other = corpus_[below(corpus_.size())];
                const std::size_t from = below(other.size());
                const std::size_t size = std::min(other.size() - from, 1 + below(64));
                input.insert(input.begin() + offset(at), other.begin() + offset(from),
                             other.begin() + offset(from + size));
                break;
            }
            case 6: {  // again, and again
                const Input piece(
                    input.begin() + offset(at),
                    input.begin() + offset(std::min(input.size(), at + 1 + below(32))));
                for (std::size_t times = 1 + below(8); times > 0; --times)
                    input.insert(input.begin() + offset(at), piece.begin(), piece.end());
                break;
            }
            case 7:  // a digit more or less, where the text has numbers
                input[at] = static_cast<std::uint8_t>('0' + below(10));
                break;
            default:
                std::swap(input[at], input[below(input.size())]);
        }
    }

    static std::ptrdiff_t offset(std::size_t value) { return static_cast<std::ptrdiff_t>(value); }

    const std::vector<Input>& corpus_;
    std::minstd_rand random_;
};

std::vector<Input> inputsOf(const fs::path& folder) {
    std::vector<fs::path> paths;
    for (const auto& entry : fs::directory_iterator(folder))
        if (entry.is_regular_file())
            paths.push_back(entry.path());
    std::sort(paths.begin(), paths.end());
    std::vector<Input> inputs;
    for (const fs::path& path : paths) inputs.push_back(read(path));
    return inputs;
}

}  // namespace

int main(int count, char** arguments) {
    if (count < 2) {
        std::fprintf(stderr, "%s CORPUS_FOLDER [INPUT]...\n", arguments[0]);
        return 2;
    }
    std::snprintf(crashFile.data(), crashFile.size(), "%s.crash",
                  fs::path(arguments[0]).filename().c_str());
    for (const int signal : {SIGABRT, SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGPROF})
        std::signal(signal, keepInput);
    if (count > 2) {
        for (int i = 2; i < count; ++i) play(read(arguments[i]));
        return 0;
    }
    const std::vector<Input> corpus = inputsOf(arguments[1]);
    if (corpus.empty()) {
        std::fprintf(stderr, "%s: no inputs\n", arguments[1]);
        return 2;
    }
    for (const Input& input : corpus) play(input);
    play({});
    const auto end =
        Clock::now() + std::chrono::seconds(number("EYRIE_FUZZ_SECONDS", kUsualSeconds));
    Mutator mutator(corpus, static_cast<unsigned>(number("EYRIE_FUZZ_SEED", 1)));
    std::size_t runs = 0;
    for (; Clock::now() < end; ++runs) play(mutator.next());
    std::printf("%zu inputs, slowest %.3f s, peak %ld MiB\n", runs + corpus.size() + 1, slowest,
                used().ru_maxrss / 1024);
    return 0;
}
