/* main.c - finds the subcommand and runs it */
#include "frame.h"

#include <string.h>

static const cmd_record *find(const char *name)
{
    for (const cmd_record *const *c = cmd_commands; *c; c++)
        if (strcmp((*c)->name, name) == 0)
            return *c;
    return NULL;
}

static int unknown(const char *name)
{
    const char *names[64];
    size_t used = 0;
    for (const cmd_record *const *c = cmd_commands; *c && used < 62; c++)
        names[used++] = (*c)->name;
    names[used++] = "help";
    names[used] = NULL;
    return cmd_unknown(name[0] == '-' ? "unknown option" : "unknown subcommand", name, names);
}

static int help(int argc, char **argv)
{
    if (argc > 2)
        return cmd_usage("'%s' is one too many: asperity help [SUBCOMMAND]", argv[2]);
    if (argc < 2) {
        frame_help(stdout);
    } else if (strcmp(argv[1], "--markdown") == 0) {
        frame_help_markdown(stdout);
    } else {
        const cmd_record *record = find(argv[1]);
        if (!record)
            return unknown(argv[1]);
        frame_help_command(stdout, record);
    }
    return CMD_OK;
}

static int run(const cmd_record *record, int argc, char **argv)
{
    cmd_args args;
    int status = frame_parse(record, argc, argv, &args);
    if (status == FRAME_HELP) {
        frame_help_command(stdout, record);
        status = CMD_OK;
    } else if (status == CMD_OK) {
        status = record->run(&args);
    }
    frame_release(&args);
    frame_release_files();
    return status;
}

int main(int argc, char **argv)
{
    int status = CMD_OK;
    frame_signals();
    if (argc < 2) {
        frame_help(stderr);
        return CMD_USAGE;
    }
    const cmd_record *record = find(argv[1]);
    if (record)
        status = run(record, argc - 1, argv + 1);
    else if (strcmp(argv[1], "help") == 0)
        status = help(argc - 1, argv + 1);
    else if (strcmp(argv[1], "--help") == 0 || strcmp(argv[1], "-h") == 0)
        frame_help(stdout);
    else if (strcmp(argv[1], "--version") == 0 && argc > 2)
        status = cmd_usage("'%s' is one too many: asperity --version", argv[2]);
    else if (strcmp(argv[1], "--version") == 0)
        printf("asperity %d.%d.%d\n", ASP_VERSION_MAJOR, ASP_VERSION_MINOR, ASP_VERSION_PATCH);
    else
        status = unknown(argv[1]);
    return status == CMD_OK ? frame_finish_output() : status;
}
