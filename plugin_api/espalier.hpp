/* The C interface for C++20, without a library of its own: results that hold a value or the reason why there is none,
 * owners of contexts and of what they hold, and structs that begin with their defaults. espalier.h is the manual; what
 * it says of threads, units and lifetimes holds here too. Nothing here throws but for want of memory (std::bad_alloc).
 */
#ifndef ESPALIER_HPP
#define ESPALIER_HPP

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <variant>

#include "espalier.h"

namespace esp {

struct Error {
    EspResult code = ESP_OK;
    std::string message;  // espLastError's
};
inline Error errorOf(EspResult code, const EspContext* context) {
    return {code, espLastError(context)};
}

/* A value, or why there is none. Asking for the one that isn't there throws std::bad_variant_access. */
template <class T>
class [[nodiscard]] Result {
  public:
    Result(T value) : state_(std::move(value)) {}
    Result(Error error) : state_(std::move(error)) {}

    bool has_value() const { return state_.index() == 0; }
    explicit operator bool() const { return has_value(); }
    T& value() & { return std::get<0>(state_); }
    const T& value() const& { return std::get<0>(state_); }
    T&& value() && { return std::get<0>(std::move(state_)); }
    T& operator*() { return value(); }
    const T& operator*() const { return value(); }
    T* operator->() { return &value(); }
    const T* operator->() const { return &value(); }
    const Error& error() const { return std::get<1>(state_); }

  private:
    std::variant<T, Error> state_;
};
struct Done {};
using Status = Result<Done>;

/* ---- Structs with their defaults ----------------------------------------------------------------------------- */

inline void setDefaults(EspContextDef& def) {
    (void)espDefaultContextDef(&def);
}
inline void setDefaults(EspGrowDef& def) {
    (void)espDefaultGrowDef(&def);
}
inline void setDefaults(EspCamera& camera) {
    (void)espDefaultCamera(&camera);
}
inline void setDefaults(EspLook& look) {
    (void)espDefaultLook(&look);
}
inline void setDefaults(EspDrawDef& def) {
    (void)espDefaultDrawDef(&def);
}
inline void setDefaults(EspLoadingDef& def) {
    (void)espDefaultLoadingDef(&def);
}
inline void setDefaults(EspPassFormat& format) {
    (void)espDefaultPassFormat(&format);
}
inline void setDefaults(EspPassDef& def) {
    (void)espDefaultPassDef(&def);
}
inline void setDefaults(EspFieldDef& def) {
    (void)espDefaultFieldDef(&def);
}
inline void setDefaults(EspPartsDef& def) {
    (void)espDefaultPartsDef(&def);
}
inline void setDefaults(EspLayerDef& def) {
    (void)espDefaultLayerDef(&def);
}
inline void setDefaults(EspBrush& brush) {
    (void)espDefaultBrush(&brush);
}
inline void setDefaults(EspSeedDef& def) {
    (void)espDefaultSeedDef(&def);
}
inline void setDefaults(EspStreamingDef& def) {
    (void)espDefaultStreamingDef(&def);
}
inline void setDefaults(EspTownDef& def) {
    (void)espDefaultTownDef(&def);
}

/* For instance defaults<EspSeedDef>(). */
template <class Struct>
Struct defaults() {
    Struct s{};
    setDefaults(s);
    return s;
}

/* name and text: not copied, alive until the grammar has been compiled. */
inline EspGrammarDef grammarDef(const char* name, std::string_view text) {
    EspGrammarDef def{};
    def.name = name;
    def.text = text.data();
    def.length = text.size();
    return def;
}

/* A def that holds the camera and the look to which it leads, so that it may be copied and changed as one. */
struct DrawDef : EspDrawDef {
    EspCamera camera = defaults<EspCamera>();
    EspLook look = defaults<EspLook>();

    DrawDef() : EspDrawDef(defaults<EspDrawDef>()) { lead(); }
    DrawDef(const DrawDef& other) : EspDrawDef(other), camera(other.camera), look(other.look) { lead(); }
    DrawDef& operator=(const DrawDef& other) {
        EspDrawDef::operator=(other);
        camera = other.camera;
        look = other.look;
        lead();
        return *this;
    }

  private:
    void lead() {
        EspDrawDef::camera = &camera;
        EspDrawDef::look = &look;
    }
};

/* As espFrameAll; the default camera where there is no context. */
inline EspCamera frameAll(const EspContext* context) {
    EspCamera camera = defaults<EspCamera>();
    (void)espFrameAll(context, &camera);
    return camera;
}

/* ---- Owners --------------------------------------------------------------------------------------------------- */

/* An object of a context, destroyed with its owner. The context must outlive it. Moved from, or default: none. */
template <class Id, EspResult (*kDestroy)(EspContext*, Id)>
class Owned {
  public:
    Owned() = default;
    Owned(EspContext* context, Id id) : context_(context), id_(id) {}
    Owned(Owned&& other) noexcept : context_(other.context_), id_(other.release()) {}
    Owned& operator=(Owned&& other) noexcept {
        std::swap(context_, other.context_);
        std::swap(id_, other.id_);
        return *this;
    }
    ~Owned() {
        if (id_.id) (void)kDestroy(context_, id_);
    }

    Id id() const { return id_; }
    explicit operator bool() const { return id_.id != 0; }
    /* Gives up ownership. */
    Id release() { return std::exchange(id_, Id{}); }

  private:
    EspContext* context_ = nullptr;
    Id id_{};
};
using Surface = Owned<EspSurface, espDestroySurface>;
using Grammar = Owned<EspGrammar, espDestroyGrammar>;
using Seed = Owned<EspSeed, espRemoveSeed>;
using Stroke = Owned<EspStroke, espDestroyStroke>;

class Context {
  public:
    static Result<Context> create(const EspContextDef& def = defaults<EspContextDef>()) {
        EspContext* made = nullptr;
        if (const EspResult code = espCreate(ESP_VERSION, &def, &made)) return errorOf(code, nullptr);
        return Context(made);
    }

    /* For all functions of espalier.h that have no method here. */
    EspContext* get() const { return context_.get(); }

    /* place: null is the identity. */
    Result<Surface> loadSurface(const char* path, const EspTransform* place = nullptr) {
        EspSurface surface{};
        return owned<Surface>(espLoadSurface(get(), path, place, &surface), surface);
    }
    /* A surface once more, elsewhere: see espPlaceAgain. */
    Result<Surface> placeAgain(EspSurface like, const EspTransform& place) {
        EspSurface surface{};
        return owned<Surface>(espPlaceAgain(get(), like, &place, &surface), surface);
    }
    Result<Grammar> compile(const EspGrammarDef& def) {
        EspGrammar grammar{};
        return owned<Grammar>(espCompileGrammar(get(), &def, &grammar), grammar);
    }
    Result<Seed> plant(const EspSeedDef& def) {
        EspSeed seed{};
        return owned<Seed>(espPlant(get(), &def, &seed), seed);
    }
    Result<Stroke> beginStroke(const EspBrush& brush) {
        EspStroke stroke{};
        return owned<Stroke>(espBeginStroke(get(), &brush, &stroke), stroke);
    }
    /* device: null for one of Espalier's own. */
    Status recreate(const EspHostDevice* device = nullptr) { return done(espRecreate(get(), device)); }
    Status update() { return done(espUpdate(get())); }
    Status draw(const EspDrawDef& def) { return done(espDraw(get(), &def)); }
    Result<EspStats> stats() {
        EspStats stats{};
        if (const EspResult code = espReadStats(get(), &stats)) return errorOf(code, get());
        return stats;
    }
    /* What a function of espalier.h answered, with its reason. */
    Status done(EspResult code) const {
        if (code != ESP_OK) return errorOf(code, get());
        return Done{};
    }

  private:
    struct Destroy {
        void operator()(EspContext* context) const { espDestroy(context); }
    };
    explicit Context(EspContext* context) : context_(context) {}

    template <class Owner, class Id>
    Result<Owner> owned(EspResult code, Id id) {
        if (code != ESP_OK) return errorOf(code, get());
        return Owner(get(), id);
    }

    std::unique_ptr<EspContext, Destroy> context_;
};

}  // namespace esp

#endif
