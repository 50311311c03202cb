# Enters: the headers of plugin_api/. Leaves: a C program that prints the layout of each struct and the value of each
# enumerator that they define. A struct that may grow and whose last field doesn't end where the struct does is marked: a
# further field could lie in what an older header's hosts leave undefined.
function field(struct, text,    name) {
    gsub(/\[[^\]]*\]/, "", text)
    name = text
    gsub(/^.*[ *]/, "", name)
    printf "    F(%s, %s);\n", struct, name
}
function body(struct, text,    count, fields, i, parts, names, j) {
    printf "    S(%s);\n", struct
    count = split(text, fields, ";")
    for (i = 1; i < count; ++i) {
        gsub(/^[ \t\n]+|[ \t\n]+$/, "", fields[i])
        if (fields[i] ~ /^ESP_STRUCT_SIZE/) {
            field(struct, "structSize")
            continue
        }
        parts = split(fields[i], names, ",")
        for (j = 1; j <= parts; ++j) field(struct, names[j])
    }
    if (text ~ /ESP_STRUCT_SIZE/) printf "    E(%s);\n", struct
}
{ all = all $0 "\n" }
END {
    while ((at = index(all, "/*")) > 0) {
        rest = substr(all, at)
        all = substr(all, 1, at - 1) substr(rest, index(rest, "*/") + 2)
    }
    print "#include <stddef.h>\n#include <stdio.h>\n\n#include \"plugin_api/espalier.h\"\n"
    print "static size_t ends;"
    print "#define S(s) printf(\"%s %zu\\n\", #s, sizeof(s))"
    print "#define F(s, f) (printf(\"    %s %zu %zu\\n\", #f, offsetof(s, f), sizeof(((s*)0)->f)), \\"
    print "                 ends = offsetof(s, f) + sizeof(((s*)0)->f))"
    print "#define E(s) (ends != sizeof(s) ? printf(\"    PADDED\\n\") : 0)\n"
    print "#define V(v) printf(\"%s = %d\\n\", #v, (int)v)\n"
    print "int main(void) {"
    rest = all
    while (match(rest, /enum Esp[A-Za-z]+ \{[^}]*\}/)) {
        text = substr(rest, RSTART, RLENGTH)
        rest = substr(rest, RSTART + RLENGTH)
        while (match(text, /ESP_[A-Z0-9_]+ =/)) {
            printf "    V(%s);\n", substr(text, RSTART, RLENGTH - 2)
            text = substr(text, RSTART + RLENGTH)
        }
    }
    while (match(all, /struct Esp[A-Za-z]+ \{[^}]*\}/)) {
        text = substr(all, RSTART, RLENGTH)
        all = substr(all, RSTART + RLENGTH)
        name = text
        sub(/^struct /, "", name)
        sub(/ \{.*$/, "", name)
        sub(/^[^{]*\{/, "", text)
        sub(/\}$/, "", text)
        body(name, text)
    }
    print "    return 0;\n}"
}
