/* commands.c - the subcommands in the order of the help: one row each */
#include "cmd.h"

#define COMMANDS(row) \
    row(list) row(eval) row(sample) row(plot) row(figures) row(render) row(convert) row(convert_ndf) row(fabricate) \
    row(fit) row(check) row(energy)

#define DECLARE(name) extern const cmd_record cmd_##name;
COMMANDS(DECLARE)

#define POINT(name) &cmd_##name,
const cmd_record *const cmd_commands[] = { COMMANDS(POINT) NULL };
