// In: a folder's models. Out: their surfaces and rows. Each model is baked by a process of its own, so that one which
// takes all memory or finds a fault of ours costs its own row and no other; surfaces are made in a folder that goes
// away with the run and are put into place by a rename.
#include <fcntl.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstring>
#include <filesystem>
#include <thread>

#include "runtime/core/file.hpp"
#include "tools/bake/main/folder.hpp"
#include "tools/bake/main/scratch.hpp"

namespace espalier::folder {
namespace {

namespace fs = std::filesystem;

volatile std::sig_atomic_t interrupted = 0;

void onSignal(int) {
    interrupted = 1;
}

// A bake that runs, and what it has said so far through its pipe.
struct Child {
    pid_t pid = -1;
    int pipe = -1;
    size_t item = 0;
    std::string surface;  // where it writes
    std::string said;
};

Row rowOf(const Item& item, const char* outcome, const std::string& message) {
    Row row;
    row["model"] = item.model;
    row["outcome"] = outcome;
    if (!message.empty()) row["message"] = message;
    return row;
}

// The child's work. Messages name the model as the report does, relative to the folder.
Row bakeOne(const Options& options, const Item& item, const std::string& surface, std::vector<InputFile>& inputs) {
    ImportOptions importing = options.importing;
    importing.inputs = &inputs;
    if (::chdir(options.folder.c_str()) != 0) return rowOf(item, "failed", item.model + ": its folder is gone");
    try {
        auto model = importModel(item.model, importing);
        if (!model) return rowOf(item, "refused", model.failure().text());
        auto baked = bake(*model, options.bake);
        if (!baked) return rowOf(item, "refused", baked.failure().text());
        Status written = writeSurface(baked->surface, surface);
        if (!written) return rowOf(item, "failed", item.model + ": " + written.failure().text());
        Row row = rowOf(item, "baked", "");
        row["surface"] = item.surface;
        row["report"] = Row::parse(baked->report.json());
        row["report"].erase("seconds");  // they differ from run to run
        return row;
    } catch (const std::bad_alloc&) {
        return rowOf(item, "failed", item.model + ": baking it takes more memory than there is");
    } catch (const std::exception& e) {  // of the file system, say
        return rowOf(item, "failed", item.model + ": " + e.what());
    }
}

[[noreturn]] void childMain(const Options& options, const Item& item, const std::string& surface, int pipe) {
    ::prctl(PR_SET_PDEATHSIG, SIGKILL);
    for (int signal : {SIGINT, SIGHUP}) ::signal(signal, SIG_IGN);  // a terminal sends them to all; the parent decides
    ::signal(SIGTERM, SIG_DFL);
    sigset_t none;
    sigemptyset(&none);
    ::sigprocmask(SIG_SETMASK, &none, nullptr);
    std::vector<InputFile> inputs;
    Row answer;
    answer["row"] = bakeOne(options, item, surface, inputs);
    answer["inputs"] = Row::array();
    for (const InputFile& input : inputs) answer["inputs"].push_back({input.path, input.hash});
    std::string text = answer.dump(-1, ' ', false, Row::error_handler_t::replace);
    for (size_t at = 0; at < text.size();) {
        ssize_t put = ::write(pipe, text.data() + at, text.size() - at);
        if (put <= 0) break;
        at += size_t(put);
    }
    ::_exit(0);
}

class Runner {
  public:
    Runner(const Options& options, std::vector<Item> items)
        : options_(options),
          items_(std::move(items)),
          cache_(options),
          rows_(items_.size()),
          progress_(items_.size(), options.quiet) {}

    Result<std::vector<Row>> run() {
        sigset_t before, open;
        takeSignals(before, open);
        if (Status made = scratch_.make(cache_.folder()); !made) return std::move(made.failure());
        size_t jobs = options_.jobs ? options_.jobs : std::max(1u, std::thread::hardware_concurrency());
        size_t next = 0;
        while (!interrupted && (next < items_.size() || !children_.empty())) {
            while (!interrupted && next < items_.size() && children_.size() < jobs) {
                begin(next++);
                heedSignals(open);  // what is known needs no waiting
            }
            if (!children_.empty()) wait(open);
        }
        for (Child& child : children_) {
            ::kill(child.pid, SIGTERM);
            ::waitpid(child.pid, nullptr, 0);
            ::close(child.pipe);
        }
        ::sigprocmask(SIG_SETMASK, &before, nullptr);
        return std::move(rows_);
    }

  private:
    // Those that end a run come through while we wait by the mask `open`, and at no other time. before: the mask so
    // far.
    static void takeSignals(sigset_t& before, sigset_t& open) {
        sigset_t blocked;
        sigemptyset(&blocked);
        ::sigprocmask(SIG_SETMASK, nullptr, &before);
        open = before;
        struct sigaction action {
        }, given{};
        action.sa_handler = onSignal;
        for (int signal : {SIGINT, SIGTERM, SIGHUP}) {
            ::sigaction(signal, nullptr, &given);
            if (signal == SIGHUP && given.sa_handler == SIG_IGN) continue;  // nohup
            ::sigaction(signal, &action, nullptr);
            sigaddset(&blocked, signal);
            sigdelset(&open, signal);
        }
        ::sigprocmask(SIG_BLOCK, &blocked, nullptr);
    }
    static void heedSignals(const sigset_t& open) {
        const timespec atOnce{};
        ::ppoll(nullptr, 0, &atOnce, &open);
    }

    void begin(size_t index) {
        const Item& item = items_[index];
        Row known = cache_.find(item);
        if (!known.is_null()) {
            progress_.finished(known, true);
            rows_[index] = std::move(known);
            return;
        }
        int ends[2];
        Child child;
        child.item = index;
        child.surface = scratch_.path() + "/" + std::to_string(index) + ".glb";
        if (::pipe2(ends, O_CLOEXEC) != 0) return finish(child, rowOf(item, "failed", item.model + ": no pipe left"));
        child.pid = ::fork();
        if (child.pid == 0) childMain(options_, item, child.surface, ends[1]);
        ::close(ends[1]);
        child.pipe = ends[0];
        if (child.pid < 0) {
            ::close(ends[0]);
            return finish(child, rowOf(item, "failed", item.model + ": no process left"));
        }
        children_.push_back(std::move(child));
        tell();
    }

    void tell() {
        std::vector<std::string> names;
        for (const Child& child : children_) names.push_back(items_[child.item].model);
        progress_.running(names);
    }

    // Waits until children have said something or ended, or a signal came.
    void wait(const sigset_t& open) {
        std::vector<pollfd> polled;
        for (const Child& child : children_) polled.push_back({child.pipe, POLLIN, 0});
        if (::ppoll(polled.data(), polled.size(), nullptr, &open) <= 0) return;
        for (size_t i = polled.size(); i-- > 0;) {
            if (!polled[i].revents) continue;
            char bytes[65536];
            ssize_t got = ::read(children_[i].pipe, bytes, sizeof bytes);
            if (got > 0) {
                children_[i].said.append(bytes, size_t(got));
                continue;
            }
            Child child = std::move(children_[i]);
            children_.erase(children_.begin() + long(i));
            ended(child);
            tell();
        }
    }

    void ended(Child& child) {
        const Item& item = items_[child.item];
        int status = 0;
        ::close(child.pipe);
        ::waitpid(child.pid, &status, 0);
        Row answer = Row::parse(child.said, nullptr, false);
        if (WIFSIGNALED(status) || !answer.is_object()) {
            std::string why = WIFSIGNALED(status) ? ::strsignal(WTERMSIG(status)) : "without an answer";
            return finish(child, rowOf(item, "failed", item.model + ": its bake ended early (" + why + ")"));
        }
        Row row = std::move(answer["row"]);
        std::vector<InputFile> inputs;
        for (const Row& input : answer["inputs"]) inputs.push_back({input[0], input[1]});
        if (row["outcome"] != "failed") {
            Status stored = cache_.store(item, row, inputs, child.surface);
            if (!stored) row = rowOf(item, "failed", item.model + ": " + stored.failure().text());
        }
        finish(child, std::move(row));
    }

    void finish(const Child& child, Row row) {
        std::error_code ignored;
        fs::remove(child.surface, ignored);
        progress_.finished(row, false);
        rows_[child.item] = std::move(row);
    }

    const Options& options_;
    std::vector<Item> items_;
    Cache cache_;
    std::vector<Row> rows_;
    Progress progress_;
    std::vector<Child> children_;
    Scratch scratch_;
};

}  // namespace

int run(const Options& given) {
    Options options = given;
    auto fail = [](const Failure& failure) {
        std::fprintf(stderr, "espalier-bake: %s\n", failure.text().c_str());
        return 1;
    };
    std::error_code error;
    fs::create_directories(options.out, error);
    if (error) return fail(Failure(options.out, "cannot be made: " + error.message()));
    options.folder = fs::absolute(options.folder).string();
    options.out = fs::absolute(options.out).string();
    auto all = listModels(options.folder, options.out);
    if (!all) return fail(all.failure());
    std::vector<Item> items;
    for (size_t i = options.shard - 1; i < all->size(); i += options.shards) items.push_back((*all)[i]);
    auto rows = Runner(options, std::move(items)).run();
    if (!rows) return fail(rows.failure());
    size_t good = 0;
    for (const Row& row : *rows) good += !row.is_null() && row["outcome"] == "baked";
    if (interrupted) {
        std::fprintf(stderr, "espalier-bake: interrupted; %zu of %zu models are baked, run again to go on\n", good,
                     rows->size());
        return 130;
    }
    if (options.shards == 1) {
        Status written = writeReport(options, *rows);
        if (!written) return fail(written.failure());
    }
    if (!options.quiet)
        std::fprintf(stderr, "%zu of %zu models baked%s\n", good, rows->size(),
                     options.shards == 1 ? ("; see " + given.out + "/report.txt").c_str() : "");
    return good == rows->size() ? 0 : 1;
}

}  // namespace espalier::folder
