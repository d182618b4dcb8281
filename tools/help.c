/* help.c - the help on the screen and the page docs/commands.md, from the same tables */
#include "frame.h"

#include <string.h>

#define WIDTH 79

/* `words`, broken between words, from column `indent` on. The cursor stands there already. */
static void put_wrapped(FILE *to, const char *words, int indent)
{
    int column = indent;
    while (*words) {
        int n = (int)strcspn(words, " ");
        if (column > indent && column + 1 + n > WIDTH) {
            fprintf(to, "\n%*s", indent, "");
            column = indent;
        } else if (column > indent) {
            fputc(' ', to);
            column++;
        }
        fprintf(to, "%.*s", n, words);
        column += n;
        words += n;
        words += strspn(words, " ");
    }
    fputc('\n', to);
}

void frame_option_text(const cmd_option *option, char *text, size_t size)
{
    char range[160];
    frame_range(option, range, sizeof range);
    if (option->kind == CMD_CHOICE)
        range[0] = 0;                      /* the argument's name lists them already */
    snprintf(text, size, "%s%s%s%s%s%s%s", option->help, range[0] ? "; " : "", range,
             option->initial ? "; default " : "", option->initial ? option->initial : "",
             option->required ? "; required" : "",
             option->many ? "; may be given more than once" : "");
}

/* `-n, --count N`, or with the short form behind in Markdown. */
static void option_name(const cmd_option *option, char *text, size_t size)
{
    char letter[8] = "";
    if (option->letter)
        snprintf(letter, sizeof letter, "-%c, ", option->letter);
    snprintf(text, size, "%s--%s%s%s", letter, option->name, option->argument ? " " : "",
             option->argument ? option->argument : "");
}

static void usage_line(FILE *to, const cmd_record *record)
{
    fprintf(to, "asperity %s%s%s", record->name, record->operands[0] ? " " : "", record->operands);
    for (const cmd_option *o = record->options; o && o->name; o++)
        if (o->required)
            fprintf(to, " --%s %s", o->name, o->argument);
    fputs(" [options]\n", to);
}

void frame_help(FILE *to)
{
    fputs("usage: asperity SUBCOMMAND [options]\n"
          "       asperity help SUBCOMMAND | --version | --help\n\n"
          "Microfacet surface appearance: evaluate, sample, plot, render, fit.\n\n", to);
    for (const cmd_record *const *c = cmd_commands; *c; c++) {
        fprintf(to, "  %-12s ", (*c)->name);
        put_wrapped(to, (*c)->summary, 15);
    }
    fputs("\nA SPEC names a distribution or a material, `asperity list` shows what there is:\n"
          "  ggx:alpha=0.3      student_t:alpha_x=0.3,alpha_y=0.1,rotation=0.5,gamma=3\n"
          "  conductor:metal=Au,ndf=(ggx:alpha=0.2)\n\n"
          "Exit status: 0 done, 1 failed, 2 the command line is wrong.\n", to);
}

void frame_help_command(FILE *to, const cmd_record *record)
{
    char name[160], text[512];
    fputs("usage: ", to);
    usage_line(to, record);
    fprintf(to, "\n%c%s.\n", record->summary[0] - ((record->summary[0] >= 'a') ? 32 : 0),
            record->summary + 1);
    if (record->details)
        fprintf(to, "\n%s\n", record->details);
    fputs("\noptions:\n", to);
    for (const cmd_option *o = record->options; o && o->name; o++) {
        option_name(o, name, sizeof name);
        frame_option_text(o, text, sizeof text);
        fprintf(to, "  %-20s%s", name, strlen(name) < 20 ? " " : "\n                       ");
        put_wrapped(to, text, 23);
    }
    fputs("  -h, --help           this text\n", to);
}

/* A cell of a table: bars would end it. */
static void put_cell(FILE *to, const char *text)
{
    for (; *text; text++) {
        if (*text == '|')
            fputc('\\', to);
        fputc(*text, to);
    }
}

void frame_help_markdown(FILE *to)
{
    char name[160], text[512];
    fputs("# The command\n\n"
          "Written by `asperity help --markdown` from the tables that the command itself reads; do\n"
          "not edit by hand.\n\n"
          "Exit status: 0 done, 1 failed, 2 the command line is wrong. Angles on the command line are\n"
          "in degrees, in files and specs in radians. Errors are one line on standard error that\n"
          "names what is wrong and what is allowed.\n\n", to);
    for (const cmd_record *const *c = cmd_commands; *c; c++)
        fprintf(to, "* [%s](#asperity-%s): %s\n", (*c)->name, (*c)->name, (*c)->summary);
    for (const cmd_record *const *c = cmd_commands; *c; c++) {
        fprintf(to, "\n## asperity %s\n\n%c%s.\n\n```\n", (*c)->name,
                (*c)->summary[0] - ((*c)->summary[0] >= 'a' ? 32 : 0), (*c)->summary + 1);
        usage_line(to, *c);
        fputs("```\n", to);
        if ((*c)->options && (*c)->options[0].name)
            fputs("\n| option | |\n|---|---|\n", to);
        for (const cmd_option *o = (*c)->options; o && o->name; o++) {
            option_name(o, name, sizeof name);
            frame_option_text(o, text, sizeof text);
            fputs("| `", to);
            put_cell(to, name);
            fputs("` | ", to);
            put_cell(to, text);
            fputs(" |\n", to);
        }
        if ((*c)->details)
            fprintf(to, "\n```\n%s\n```\n", (*c)->details);
    }
}
