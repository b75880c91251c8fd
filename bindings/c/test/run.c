/* Prints a run of a lab of a lesson as numbers with 17 digits: time, then the displayed values, for the start and every step.
 *     run LESSON ADDRESS MODELS STEPS */
#include "labspec.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

static void check(labspec_status status)
{
    if (status != LABSPEC_OK) {
        fprintf(stderr, "%s: %s\n", labspec_last_error_code(), labspec_last_error());
        exit(1);
    }
}

static char *read_file(const char *path)
{
    FILE *file = fopen(path, "rb");
    long size = 0;
    if (file == NULL || fseek(file, 0, SEEK_END) != 0 || (size = ftell(file)) < 0 || fseek(file, 0, SEEK_SET) != 0) {
        fprintf(stderr, "cannot read %s\n", path);
        exit(2);
    }
    char *text = calloc((size_t)size + 1, 1);
    if (text == NULL || fread(text, 1, (size_t)size, file) != (size_t)size) exit(2);
    fclose(file);
    return text;
}

int main(int argc, char **argv)
{
    if (argc != 5) return 2;
    char *lesson = read_file(argv[1]);
    size_t steps = strtoul(argv[4], NULL, 10), width = 0, length = 0;
    labspec_model_source models = {.struct_size = sizeof models, .folder = argv[3]};
    labspec_lab *lab = NULL;
    check(labspec_lab_open_lesson(argv[1], lesson, argv[2], &models, &lab));
    check(labspec_lab_displayed_count(lab, &width));
    double *row = malloc((width + 1) * sizeof *row);
    if (row == NULL) return 2;
    for (size_t step = 0; step <= steps; step++) {
        if (step > 0) check(labspec_lab_step(lab, 1));
        check(labspec_lab_time(lab, row));
        check(labspec_lab_numbers(lab, row + 1, width, &length));
        for (size_t i = 0; i <= length; i++) {
            if (isnan(row[i])) {
                printf("nan");
            } else {
                printf("%.17g", row[i]);
            }
            putchar(i == length ? '\n' : ',');
        }
    }
    check(labspec_lab_free(lab));
    free(row);
    free(lesson);
    return 0;
}
