/* Just enough JSON to read the bench's messages, without memory of its own.
 *
 * A value is a pointer to its first character inside a line. The bench writes valid JSON, so
 * nothing is checked here beyond the end of the line.
 */
#ifndef SMALL_JSON_H
#define SMALL_JSON_H

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const char *json_blank(const char *p) { return p + strspn(p, " \t\r\n"); }

/* Behind a value. */
static const char *json_skip(const char *p) {
    int depth = 0;
    do {
        if (*p == '"') {
            for (p++; *p && *p != '"'; p++) {
                if (*p == '\\' && p[1]) {
                    p++;
                }
            }
        } else if (*p == '{' || *p == '[') {
            depth++;
        } else if (*p == '}' || *p == ']') {
            depth--;
        } else if (depth == 0) {
            return p + strcspn(p, ",]} \t\r\n");
        }
        if (*p) {
            p++;
        }
    } while (*p && depth > 0);
    return p;
}

/* The value of a member of an object; null if it is not there. */
static const char *json_member(const char *object, const char *key) {
    size_t length = strlen(key);
    const char *p = json_blank(object + 1);
    while (*p == '"') {
        const char *value = json_blank(json_blank(json_skip(p)) + 1);
        if (strncmp(p + 1, key, length) == 0 && p[1 + length] == '"') {
            return value;
        }
        p = json_blank(json_skip(value));
        if (*p == ',') {
            p = json_blank(p + 1);
        }
    }
    return NULL;
}

/* The first element of an array, or null; and the one behind an element, or null. */
static const char *json_first(const char *array) {
    const char *p = json_blank(array + 1);
    return *p == ']' ? NULL : p;
}

static const char *json_next(const char *element) {
    const char *p = json_blank(json_skip(element));
    return *p == ',' ? json_blank(p + 1) : NULL;
}

/* A number; NaN for null. */
static double json_number(const char *value) {
    return value == NULL || *value == 'n' ? NAN : strtod(value, NULL);
}

static double json_member_number(const char *object, const char *key) {
    return json_number(json_member(object, key));
}

/* Both numbers of a pair. */
static void json_pair(const char *array, double *first, double *second) {
    const char *element = json_first(array);
    *first = json_number(element);
    *second = json_number(json_next(element));
}

#endif
