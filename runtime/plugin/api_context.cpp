// Creation, destruction and errors of contexts, and the tables that kernels read a scene by.
#include "runtime/core/platform.hpp"
#include "runtime/gpu/features.hpp"
#include "runtime/plugin/context.hpp"
#include "runtime/plugin/device_parts.hpp"
#include "runtime/plugin/errors.hpp"

namespace espalier {
namespace {

// Of the terminal meshes, seen from where the library lies (or the program that it is linked into): beside its folder,
// as in the build and in a game's own folders, or where installing has put them.
std::filesystem::path contentFolder() {
    const std::filesystem::path library = platform::fileOfCode(reinterpret_cast<const void*>(&espCreate));
    std::error_code ignored;
    std::filesystem::path beside = library.parent_path().parent_path() / "content";
    std::filesystem::path installed = library.parent_path() / ESPALIER_INSTALLED_CONTENT;
    const bool moved = !std::filesystem::exists(beside, ignored) && std::filesystem::exists(installed, ignored);
    return moved ? installed.lexically_normal() : beside;
}

Log logInto(EspLogFn log, void* user) {
    if (!log) {
        return [stderrLog = logToStderr()](Severity severity, std::string_view text) {
            if (severity != Severity::info) stderrLog(severity, text);
        };
    }
    static_assert(uint32_t(Severity::warning) == ESP_LOG_WARNING && uint32_t(Severity::error) == ESP_LOG_ERROR);
    return [log, user](Severity severity, std::string_view text) {
        log(user, EspLogLevel(severity), std::string(text).c_str());
    };
}

EspResult create(EspContextDef def, EspContext** out) {
    const EspHostDevice host = takenOr("espCreate: host", def.host, EspHostDevice{});
    if (def.host) def.host = &host;
    if (def.host)
        if (const char* mistake = espalier::mistakeIn(host)) throw Refusal{std::string("espCreate: ") + mistake};
    auto context = std::make_unique<EspContext>();
    context->log = logInto(def.log, def.logUser);
    setDefaults(context->grow);
    if (def.files) {
        const EspFiles files = taken("espCreate: files", def.files);
        if (!files.read || !files.release)
            return failAlone(ESP_INVALID_ARGUMENT, "espCreate: EspFiles needs both functions, read and release");
        context->files = Files(files);
    }
    if (def.cacheFolder) context->cacheFolder = def.cacheFolder;

    const std::filesystem::path folder = def.files ? std::filesystem::path() : contentFolder();
    context->terminals = def.terminals ? def.terminals : folder / "terminals.glb";
    context->roofMeshFile = std::filesystem::path(context->terminals).replace_filename("roofs.glb");
    context->patterns.shipped = std::filesystem::path(context->terminals).replace_filename("pieces.glb");
    context->validation = def.validation != 0;
    context->checksDevice = def.skipSelfCheck == 0;
    DeviceParts parts;
    std::string why;
    if (EspResult bad = makeDeviceParts(*context, def.host, parts, why)) return failAlone(bad, why);
    context->device = std::move(parts.device);
    context->renderer = std::move(parts.renderer);
    context->growth = std::move(parts.growth);
    *out = context.release();
    return ESP_OK;
}

uint32_t majorOf(uint32_t version) {
    return version >> 22;
}
uint32_t minorOf(uint32_t version) {
    return version >> 12 & 0x3FF;
}
std::string versionText(uint32_t version) {
    return std::to_string(majorOf(version)) + "." + std::to_string(minorOf(version)) + "." +
           std::to_string(version & 0xFFF);
}

// Whether we know all that this header's hosts say. Before 1.0 each minor version may change what it likes.
bool serves(uint32_t header) {
    const bool alike =
        majorOf(header) == ESP_VERSION_MAJOR && (ESP_VERSION_MAJOR > 0 || minorOf(header) == ESP_VERSION_MINOR);
    return alike && header <= ESP_VERSION;
}

struct RequiredFeatures {
    Features features;
    RequiredFeatures() { chooseFeatures(Features(), features); }
};

constexpr const char* kRequiredExtensions[] = {VK_KHR_PUSH_DESCRIPTOR_EXTENSION_NAME};

}  // namespace

std::string& errorAlone() {
    thread_local std::string error;
    return error;
}

EspResult fail(const EspContext* context, EspResult code, std::string message) {
    try {
        context->error = std::move(message);
        context->log(Severity::error, context->error);
    } catch (...) {
        // The code alone has to do.
    }
    return code;
}

EspResult gpuCode(const Device& device, const Failure& failure) {
    using Cause = Failure::Cause;
    if (device.lost() || failure.cause == Cause::lost) return ESP_DEVICE_LOST;
    if (failure.cause == Cause::fault) return ESP_NO_DEVICE;
    return failure.cause == Cause::driver ? ESP_DRIVER_FAILED : ESP_OUT_OF_MEMORY;
}

EspResult failContent(const EspContext* context, const Failure& failure) {
    return fail(context, ESP_INVALID_CONTENT, failure.text());
}

EspResult failGpu(const EspContext* context, const Failure& failure) {
    return fail(context, gpuCode(*context->device, failure), failure.text());
}

EspResult failWork(const EspContext* context, const Failure& failure) {
    return failure.ofDevice() ? failGpu(context, failure) : failContent(context, failure);
}

EspResult readWhole(const EspContext* context, const std::string& path, std::vector<std::byte>& bytes) {
    Result<std::vector<std::byte>> file = context->files.read(path);
    if (!file) return fail(context, ESP_IO_FAILED, file.failure().text());
    bytes = std::move(*file);
    return ESP_OK;
}

}  // namespace espalier

using namespace espalier;

extern "C" {

EspResult espDefaultContextDef(EspContextDef* out) {
    return giveDefaults("espDefaultContextDef", out);
}

EspResult espCreate(uint32_t headerVersion, const EspContextDef* def, EspContext** out) {
    return guardedAlone([&] {
        if (!out) return failAlone(ESP_INVALID_ARGUMENT, "espCreate: null pointer");
        *out = nullptr;
        if (!serves(headerVersion))
            return failAlone(ESP_WRONG_VERSION, "espCreate: the host was compiled with the header of version " +
                                                    versionText(headerVersion) + ", which the library, version " +
                                                    ESPALIER_VERSION + ", can't serve");
        return create(taken("espCreate", def), out);
    });
}

void espDestroy(EspContext* context) {
    if (!context) return;
    try {
        if (!finishFrames(*context->device, "destroy")) (void)context->device->waitIdle();
    } catch (...) {  // without memory for that the host's frames are not waited for
    }
    delete context;  // which waits for what we have submitted
}

EspResult espTrim(EspContext* context) {
    return guarded(context, [&] {
        context->plants.reset();
        context->parts = {};
        context->growth->trim();
        if (context->roofs) context->roofs->trim();
        context->renderer->trim(context->growth->view());
        // What was dropped goes with the last frame that may read it.
        if (Status done = finishFrames(*context->device, "trim"); !done) return failGpu(context, done.failure());
        context->device->memory().trim();
        return ESP_OK;
    });
}

const void* espRequiredFeatures(void) {
    static const RequiredFeatures required;
    return &required.features.core;
}

const char* const* espRequiredExtensions(uint32_t* count) {
    if (count) *count = uint32_t(std::size(kRequiredExtensions));
    return kRequiredExtensions;
}

const char* espLastError(const EspContext* context) {
    return context ? context->error.c_str() : errorAlone().c_str();
}

#define ESPALIER_TEXT(major, minor, patch) #major "." #minor "." #patch
#define ESPALIER_TEXT_OF(major, minor, patch) ESPALIER_TEXT(major, minor, patch)
static_assert(std::string_view(ESPALIER_VERSION) ==
              ESPALIER_TEXT_OF(ESP_VERSION_MAJOR, ESP_VERSION_MINOR, ESP_VERSION_PATCH));

const char* espVersion(void) {
    return ESPALIER_VERSION;
}

const char* espDeviceName(const EspContext* context) {
    return context ? context->device->info().name.c_str() : "";
}

const char* espDriverName(const EspContext* context) {
    return context ? context->device->info().driver.c_str() : "";
}

}  // extern "C"
