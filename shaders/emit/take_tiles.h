// Of the tiles of a watched picture that edits have changed, the next ones are taken. They come in strips of rows, column
// by column, so that they lie close together. The text of a kernel, and in C++ of a member: `push` is around it.
uint takePlaces() {
    uint strip = push.columns * kTakenStrip;
    return (push.tiles + strip - 1u) / strip * strip;
}
uint tileAt(uint place) {
    uint along = place / kTakenStrip;
    return (along / push.columns * kTakenStrip + place % kTakenStrip) * push.columns + along % push.columns;
}
bool changedAt(uint place) {
    uint tile = tileAt(place);
    uint bits = kKeptTile;
    if (tile < push.tiles) bits = floatBitsToUint(push.watched.v[tile]);
    return bits == kChangedTile;
}
// Those of a run of places, counted from where the last ones ended. rank: how many have changed before the run.
void takeRun(uint begin, uint first, uint end, uint rank) {
    uint places = takePlaces();
    for (uint i = first; i < end; ++i) {
        uint place = (begin + i) % places;
        uint tile = tileAt(place);
        bool changed = changedAt(place);
        bool takes = changed && rank < push.most;
        rank += changed ? 1u : 0u;
        if (tile < push.tiles) push.taken.v[tile] = uintBitsToFloat(takes ? kChangedTile : kKeptTile);
        if (takes) push.watched.v[tile] = uintBitsToFloat(kKeptTile);
        if (takes && rank == push.most) push.taken.v[push.tiles] = uintBitsToFloat((place + 1u) % places);
    }
}
