// Saves and autosaves that are killed at any moment: what opens afterwards.
#include <OpenImageIO/imageio.h>
#include <signal.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <climits>
#include <cstdlib>
#include <filesystem>
#include <set>

#include "tests/editor/editing.hpp"
#include "tools/document/project.hpp"

using namespace espalier::document;
using espalier::scene::Scene;

namespace {

// What a project is to hold: all that is written of it, and what opening it has to give.
struct Version {
    ProjectData data;
    uint64_t growth = 0;
    std::vector<std::vector<float>> layers;
};
constexpr int kVersions = 4;
constexpr const char* kLayers[] = {"mask", "damp"};

std::vector<std::vector<float>> layersOf(Editing& editing) {
    std::vector<std::vector<float>> layers;
    for (const char* layer : kLayers) {
        espalier::scene::GreyPicture picture;
        REQUIRE_MESSAGE(editing.document->readLayer(0, layer, picture, editing.error), editing.error);
        layers.push_back(picture.texels);
    }
    return layers;
}

// Another plant that is frozen, another one that grows, other layers.
Version anyVersion(std::mt19937& random, Editing& editing) {
    const auto chance = [&](float low, float high) { return std::uniform_real_distribution<float>(low, high)(random); };
    const uint32_t first = editing.document->scene().seeds[0].key;
    const auto perform = [&](const Action& action) { REQUIRE_MESSAGE(editing.perform(action), editing.error); };
    if (editing.document->scene().seeds[0].frozen) perform(FreezeSeeds{{first}, false});
    for (const uint32_t grammar : {0u, 1u}) perform(SetParam{grammar, {"reach", {chance(.4f, 1.2f)}}});
    editing.hash();
    perform(FreezeSeeds{{first}, true});
    for (const uint32_t grammar : {0u, 1u}) perform(SetParam{grammar, {"reach", {chance(.4f, 1.2f)}}});
    for (const char* layer : kLayers) {
        espalier::scene::GreyPicture noise{128, 128, std::vector<float>(128 * 128)};
        for (float& texel : noise.texels) texel = chance(.4f, 1);
        perform(LoadLayer{layer, "", 0, std::make_shared<std::vector<espalier::scene::GreyPicture>>(1, noise)});
    }
    Version version{{}, editing.hash(), layersOf(editing)};
    REQUIRE_MESSAGE(gather(*editing.document, version.data, editing.error), editing.error);
    return version;
}

// Opens projects as an editor does, one after the other in one context: the making of that takes longest.
class Reader {
  public:
    explicit Reader(const std::string& scene) : editing_(scene) {}
    // Which version the file holds; -1: none.
    int versionIn(const std::string& file, const std::vector<Version>& versions) {
        EspContext* context = editing_.context.get();
        for (const auto& grammar : editing_.document->scene().grammars) espDestroyGrammar(context, grammar.id);
        for (const auto& surface : editing_.document->scene().surfaces) espDestroySurface(context, surface.id);
        editing_.document = std::make_unique<Document>(context);
        espalier::scene::Request request;
        request.file = file;
        REQUIRE_MESSAGE(editing_.document->open(request, editing_.error), editing_.error);
        const Scene& scene = editing_.document->scene();
        CHECK(scene.notes.empty());
        REQUIRE(scene.seeds.size() == 2);
        CHECK(scene.seeds[0].frozen);
        const uint64_t growth = editing_.hash();
        const auto layers = layersOf(editing_);
        for (int i = 0; i < kVersions; ++i)
            if (versions[size_t(i)].growth == growth && versions[size_t(i)].layers == layers) return i;
        return -1;
    }

  private:
    Editing editing_;
};

// A file's version before the write that is under way, and after it; told by the child that writes, while it lives.
struct Told {
    std::atomic<int> before = -1, after = -1;
    bool has(int version) const { return version == before || version == after; }
    void is(int version) { before = after = version; }
};
struct Both {
    Told project, autosave;
};

// Autosaves and saves, each of the next version, for ever: the child has none of our threads, and no device.
[[noreturn]] void writeOn(const std::vector<Version>& versions, int version, const std::string& garden, Both& told,
                          int rounds) noexcept {
    Progress progress;
    std::string error;
    for (int i = 0; i < rounds; ++i) {
        version = (version + 1) % kVersions;
        for (const auto& [file, write] : {std::pair(&told.autosave, &writeAutosave), {&told.project, &writeProject}}) {
            file->after = version;
            if (!write(versions[size_t(version)].data, garden, progress, error)) _exit(1);
            file->before = version;
        }
    }
    _exit(0);
}

}  // namespace

TEST_CASE("killed at any moment of a save or an autosave, the project opens as it was or as it should be") {
    // In a process of its own: the picture library's threads, which other cases have started, are no child's.
    if (!std::getenv("ESPALIER_TEST_ALONE")) {
        const std::string self = std::filesystem::read_symlink("/proc/self/exe").string();
        const Ran alone = run("ESPALIER_TEST_ALONE=1 " + self + " -tc='killed at any moment of a save*'");
        CHECK_MESSAGE(alone.code == 0, alone.output);
        return;
    }
    const Folder folder;
    const std::string garden = folder.file("garden");
    // A forked child has no threads but the one that forked.
    OIIO::attribute("exr_threads", -1);
    OIIO::attribute("threads", 1);
    std::mt19937 random(3);
    std::vector<Version> versions;
    const std::string scene = wallScene(folder, false);
    {
        Editing editing(scene);
        for (int i = 0; i < kVersions; ++i) versions.push_back(anyVersion(random, editing));
    }
    Reader reader(scene);
    void* shared = mmap(nullptr, sizeof(Both), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    REQUIRE(shared != MAP_FAILED);
    Both& told = *new (shared) Both;
    const auto child = [&](int rounds) {
        const pid_t made = fork();
        REQUIRE(made >= 0);
        if (made == 0) writeOn(versions, told.project.before, garden, told, rounds);
        return made;
    };
    // How long it takes a child here and now to write two versions, with its beginning.
    const auto begin = std::chrono::steady_clock::now();
    int status = 0;
    waitpid(child(2), &status, 0);
    REQUIRE(status == 0);
    const auto two = std::chrono::steady_clock::now() - begin;
    const auto longest = std::max<int64_t>(1, std::chrono::duration_cast<std::chrono::microseconds>(two).count());
    std::set<int> seen;
    int killed = 0, interrupted = 0, recovered = 0, rounds = 0;
    // At least a hundred, and where the machine's other work leaves few kills between an autosave and its project,
    // more.
    for (; rounds < 100 || ((interrupted <= 5 || recovered <= 5) && rounds < 400); ++rounds) {
        CAPTURE(rounds);
        const pid_t writing = child(INT_MAX);
        usleep(useconds_t(random() % std::min<uint64_t>(uint64_t(longest), 400000)));
        kill(writing, SIGKILL);
        waitpid(writing, &status, 0);
        killed += WIFSIGNALED(status);
        interrupted += told.project.before != told.project.after;
        const int version = reader.versionIn(garden, versions);
        REQUIRE_MESSAGE(told.project.has(version), "version ", version);
        // An autosave that was whole before its project was to follow is offered, unless that is there already.
        const std::string left = recoverable(garden);
        if (version == told.project.before && told.autosave.before != version) CHECK(!left.empty());
        if (!left.empty()) {
            const int kept = reader.versionIn(left, versions);
            REQUIRE_MESSAGE(told.autosave.has(kept), "version ", kept);
            told.autosave.is(kept);
            ++recovered;
        }
        told.project.is(version);
        seen.insert(version);
    }
    CHECK(killed == rounds);
    CHECK(rounds >= 100);
    CHECK(interrupted > 5);
    CHECK(recovered > 5);
    CHECK(seen.size() == kVersions);
    // What an interrupted save left behind goes with the next: the text, two layers, the bake under them and a plant
    // are left.
    Progress progress;
    std::string error;
    REQUIRE_MESSAGE(writeProject(versions[0].data, garden, progress, error), error);
    CHECK(recoverable(garden).empty());
    size_t files = 0;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(garden)) files += entry.is_regular_file();
    CHECK(files == 5);
    CHECK(reader.versionIn(garden, versions) == 0);
    munmap(shared, sizeof(Both));
}
