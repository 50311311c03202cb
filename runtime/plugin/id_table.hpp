#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <utility>
#include <vector>

#include "runtime/plugin/context_number.hpp"

namespace espalier {

// Objects by plain 32-bit ids:
//
//   31        26 25                0
//   | context  | generation | place |
//
// Generations begin at 1, so that 0 is no object. A place is used again with the next generation; once its generations
// are used up it stays empty, so no id ever comes twice. The context's number makes other contexts refuse the id.
// T: movable. A value stays where it is until it is erased, so that strings of its own may be handed out.
template <class T, uint32_t kPlaceBits>
class IdTable {
  public:
    static constexpr uint32_t kMaxPlaces = (1u << kPlaceBits) - 1;
    static constexpr uint32_t kGenerationBits = 32 - kContextBits - kPlaceBits;
    static constexpr uint32_t kLastGeneration = (1u << kGenerationBits) - 1;

    // context: a ContextNumber.
    explicit IdTable(uint32_t context) : context_(context << (kGenerationBits + kPlaceBits)) {}
    // Of the object of this id, or of what was there.
    static uint32_t placeOf(uint32_t id) { return id & kMaxPlaces; }

    // 0 if there is no place left.
    uint32_t insert(T value) {
        const uint32_t id = reserve();
        if (id) put(id, std::move(value));
        return id;
    }

    // An id whose object comes later: until put() nothing is found under it. 0 if there is no place left.
    uint32_t reserve() {
        uint32_t place;
        if (!free_.empty()) {
            place = free_.back();
            free_.pop_back();
        } else {
            if (slots_.size() >= kMaxPlaces) return 0;
            place = uint32_t(slots_.size());
            // So that erase can't run out of memory.
            if (free_.capacity() <= slots_.size()) free_.reserve(2 * slots_.size() + 1);
            slots_.emplace_back();
        }
        return context_ | (slots_[place].generation << kPlaceBits) | place;
    }
    void put(uint32_t id, T value) {
        slots_[placeOf(id)].value.emplace(std::move(value));
        ++count_;
    }
    // The object goes, its id stays reserved.
    T take(uint32_t id) {
        Slot& slot = *slotOf(id);
        T value = std::move(*slot.value);
        slot.value.reset();
        --count_;
        return value;
    }
    // Gives up an id that is reserved.
    void release(uint32_t id) {
        Slot& slot = slots_[placeOf(id)];
        if (slot.generation == kLastGeneration) return;
        ++slot.generation;
        free_.push_back(placeOf(id));
    }

    T* find(uint32_t id) {
        Slot* slot = slotOf(id);
        return slot ? &*slot->value : nullptr;
    }
    const T* find(uint32_t id) const { return const_cast<IdTable*>(this)->find(id); }

    bool erase(uint32_t id) {
        Slot* slot = slotOf(id);
        if (!slot) return false;
        slot->value.reset();
        --count_;
        release(id);
        return true;
    }

    uint32_t size() const { return count_; }

    // Of what is at a place; 0: nothing.
    uint32_t idAt(uint32_t place) const {
        if (place >= slots_.size() || !slots_[place].value) return 0;
        return context_ | (slots_[place].generation << kPlaceBits) | place;
    }
    // Of the index-th in order of places; index below size().
    uint32_t nth(uint32_t index) const {
        uint32_t place = count_ == slots_.size() ? index : 0;  // all are taken
        for (uint32_t before = place; !slots_[place].value || before < index; ++place)
            before += slots_[place].value.has_value();
        return idAt(place);
    }

    // visit(id, value) in order of places.
    template <class F>
    void forEach(F&& visit) {
        for (uint32_t place = 0; place < slots_.size(); ++place)
            if (slots_[place].value) visit(idAt(place), *slots_[place].value);
    }
    template <class F>
    void forEach(F&& visit) const {
        const_cast<IdTable*>(this)->forEach([&](uint32_t id, const T& value) { visit(id, value); });
    }

  private:
    struct Slot {
        std::optional<T> value;
        uint32_t generation = 1;
    };

    Slot* slotOf(uint32_t id) {
        const uint32_t place = placeOf(id);
        return id != 0 && idAt(place) == id ? &slots_[place] : nullptr;
    }

    uint32_t context_;  // in the bits of ids
    std::deque<Slot> slots_;
    std::vector<uint32_t> free_;
    uint32_t count_ = 0;
};

}  // namespace espalier
