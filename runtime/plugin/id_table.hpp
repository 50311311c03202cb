#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <utility>
#include <vector>

namespace espalier {

// Objects by plain 32-bit ids: bits 31..20 generation (from 1), 19..0 place + 1, so that 0 is no object. A place
// is used again with the next generation; once its generations are used up it stays empty, so no id ever comes
// twice. T: movable. A value stays where it is until it is erased, so that strings of its own may be handed out.
template <class T>
class IdTable {
  public:
    static constexpr uint32_t kPlaceBits = 20;
    static constexpr uint32_t kMaxPlaces = (1u << kPlaceBits) - 2;
    static constexpr uint32_t kLastGeneration = (1u << (32 - kPlaceBits)) - 1;

    // 0 if there is no place left.
    uint32_t insert(T value) {
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
        slots_[place].value.emplace(std::move(value));
        ++count_;
        return idAt(place);
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
        if (slot->generation < kLastGeneration) {
            ++slot->generation;
            free_.push_back(placeOf(id));
        }
        return true;
    }

    uint32_t size() const { return count_; }

    // Of what is at a place; 0: nothing.
    uint32_t idAt(uint32_t place) const {
        if (place >= slots_.size() || !slots_[place].value) return 0;
        return (slots_[place].generation << kPlaceBits) | (place + 1);
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

    static uint32_t placeOf(uint32_t id) { return (id & ((1u << kPlaceBits) - 1)) - 1; }
    Slot* slotOf(uint32_t id) {
        const uint32_t place = placeOf(id);
        if (id == 0 || place >= slots_.size()) return nullptr;
        Slot& slot = slots_[place];
        return slot.value && slot.generation == id >> kPlaceBits ? &slot : nullptr;
    }

    std::deque<Slot> slots_;
    std::vector<uint32_t> free_;
    uint32_t count_ = 0;
};

}  // namespace espalier
