/* program_fault - messages to the importer about faults and notes in a part program, with file,
 * line, column and quoted text. Included after fmi_model.h. */
#ifndef PROGRAM_FAULT_H
#define PROGRAM_FAULT_H

#include <math.h>
#include <string.h>

#include "fault.h"
#include "program_file.h"

/* A part of the line that a report is about. */
struct quote {
    char text[SOURCE_LINE_MAX + 1];
};

static struct quote quote(const struct source *program, const struct fault_report *r, int32_t at,
                          int32_t length)
{
    const char *text = "";
    const int64_t there = program->look(program->context, r->file, r->offset, &text);
    struct quote q;
    snprintf(q.text, sizeof q.text, "%.*s", there < at + length ? 0 : (int)length, text + at);
    return q;
}

/* Name of the file that a report is about: the program, or a file that it calls. */
struct file_name {
    char text[1200];
};

static struct file_name file_of(const char *program, const struct fault_report *r)
{
    struct file_name n;
    snprintf(n.text, sizeof n.text, r->file[0] ? "%s: %s.ngc" : "%s", program, r->file);
    return n;
}

/* A program as a parameter names it, and the letters of its axes; A B C turn. */
struct named_program {
    const char *parameter, *name, *axes;
    const struct source *text;
};

/* What is told about a fault. */
struct fault_words {
    char text[FMU_STRING_MAX + 2 * SOURCE_LINE_MAX + 256];
};

/* The words for a fault in a line of a program. */
static struct fault_words fault_words(const struct named_program *p, const struct fault_report *r)
{
    const struct source *program = p->text;
    struct fault_words words;
    char detail[SOURCE_LINE_MAX + 96] = "";

    if (r->other_length) {
        snprintf(detail, sizeof detail, " beside \"%s\"",
                 quote(program, r, r->other_at, r->other_length).text);
    } else if (r->fault == FAULT_FEED) {
        snprintf(detail, sizeof detail, " (%.6g, limit %.6g)", r->value, r->limit);
    } else if (r->fault == FAULT_SPEED) {
        snprintf(detail, sizeof detail, " (%.6g, limit %.6g; F%.0f mm/min is possible)", r->value,
                 r->limit, floor(r->feed));
    } else if (r->fault == FAULT_TRAVEL) {
        const char letter = p->axes[r->axis];
        const char *unit = strchr("ABC", letter) ? "deg" : "mm";
        snprintf(detail, sizeof detail, " (%c to %.6g %s, limit %.6g %s)", letter, r->value, unit,
                 r->limit, unit);
    } else if (r->fault == FAULT_ARC_END) {
        snprintf(detail, sizeof detail, " (by %.6g mm)", r->value);
    } else if (r->fault == FAULT_ARC_CHORD) {
        snprintf(detail, sizeof detail, " (%.6g mm, half the distance is %.6g mm)", r->value,
                 r->limit);
    }
    const struct quote q = quote(program, r, r->at, r->length);
    const int n = snprintf(words.text, sizeof words.text, "%s: line %d: %s",
                           file_of(p->name, r).text, (int)r->line, fault_text(r->fault));
    const bool quoted = r->fault < FAULT_WHILE_PROGRAM || r->fault > FAULT_FROM_HELD;
    if (quoted && n > 0 && (size_t)n < sizeof words.text) {
        snprintf(words.text + n, sizeof words.text - (size_t)n, " \"%s\"%s, column %d", q.text,
                 detail, (int)r->at + 1);
    }
    return words;
}

/* Send the notes on a program, and refuse it if it has a fault. */
static int judge_program(struct fmu *f, const struct named_program *p, const struct fault_list *all)
{
    const struct program_file *file = p->text->context;
    const struct source *program = p->text;
    int status = 0;

    for (int i = 0; i < all->notes; i++) {
        const struct fault_report *r = &all->note[i];
        char detail[96] = "";
        if (r->fault == FAULT_NOTE_FEED) {
            snprintf(detail, sizeof detail, " (%.6g, limit %.6g)", r->value, r->limit);
        }
        fmu_warn(f, "%s: line %d: note: %s \"%s\"%s, column %d", file_of(p->name, r).text,
                 (int)r->line, fault_text(r->fault), quote(program, r, r->at, r->length).text,
                 detail, (int)r->at + 1);
    }
    for (int i = 0; i < all->count; i++) {
        status = all->of[i].fault != FAULT_READ
                     ? fmu_fail(f, "%s", fault_words(p, &all->of[i]).text)
                     : fmu_fail(f, "%s: cannot read %s: %s", p->parameter,
                                file_of(p->name, &all->of[i]).text, strerror(file->error));
    }
    return all->more ? fmu_fail(f, "%s: ... and more", p->name) : status;
}

/* Open the program that a parameter names; NULL without a name. */
static int open_program(struct fmu *f, const char *parameter, const char *name,
                        struct program_file **program)
{
    *program = NULL;
    if (!name[0]) {
        return 0;
    }
    const struct fmu_path path = fmu_path(f, name, FMU_READ);
    const char *why = path.good ? program_open(path.text, program) : path.text;
    if (why) {
        return fmu_fail(f, "%s: cannot read %s: %s", parameter, name, why);
    }
    return *program ? 0 : fmu_fail(f, "%s: %s is empty", parameter, name);
}

#endif
