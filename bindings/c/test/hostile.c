/* Calls every function with NULL, freed, foreign, misaligned and wrong-sized arguments, and checks the statuses; then checks that
 * the objects give the same numbers as before. */
#include "expect.h"

/* Pointers that are no handles: an object of the caller, small numbers, the largest one. */
static void *const WRONG[] = {&failures, (void *)8, (void *)(uintptr_t)0x7fff0000, (void *)UINTPTR_MAX};
#define WRONGS (sizeof WRONG / sizeof *WRONG)
/* An aligned place, and one beside it. */
static double place[16];
#define MISALIGNED(type) ((type *)(void *)((char *)place + 1))

static void lab_handle(labspec_status wanted, labspec_lab *lab)
{
    double x[8];
    size_t n = 0;
    int32_t flag = 0;
    char text[8];
    const char *option = NULL;
    labspec_control control = {.struct_size = sizeof control};
    labspec_displayed displayed = {.struct_size = sizeof displayed};
    labspec_check_report *report = (labspec_check_report *)WRONG[0];
    labspec_lab_state *state = NULL;
    labspec_model *model = NULL;
#define LAB(call) expect(wanted, call, #call, __LINE__)
    LAB(labspec_lab_step(lab, 1));
    LAB(labspec_lab_play_to(lab, 1, &n));
    LAB(labspec_lab_reset(lab));
    LAB(labspec_lab_time(lab, x));
    LAB(labspec_lab_timestep(lab, x));
    LAB(labspec_lab_is_over(lab, &flag));
    LAB(labspec_lab_apply_force(lab, 1, x, 6));
    LAB(labspec_lab_record(lab, 1, x, 8, &n));
    LAB(labspec_lab_read(lab, "qpos", x, 8, &n));
    LAB(labspec_lab_model(lab, &model));
    LAB(labspec_lab_findings(lab, &report));
    CHECK(report == NULL && model == NULL);
    LAB(labspec_lab_save(lab, &state));
    LAB(labspec_lab_restore(lab, state));
    LAB(labspec_lab_control_count(lab, &n));
    LAB(labspec_lab_control(lab, 0, &control));
    LAB(labspec_lab_control_option(lab, 1, 0, &option));
    LAB(labspec_lab_control_number(lab, "gravity", x));
    LAB(labspec_lab_control_text(lab, "gravity", text, 8, &n));
    LAB(labspec_lab_set_number(lab, "gravity", -1));
    LAB(labspec_lab_set_text(lab, "push", "yes"));
    LAB(labspec_lab_set_boolean(lab, "push", 1));
    LAB(labspec_lab_press(lab, "kick"));
    LAB(labspec_lab_displayed_count(lab, &n));
    LAB(labspec_lab_displayed(lab, 0, &displayed));
    LAB(labspec_lab_numbers(lab, x, 8, &n));
    LAB(labspec_lab_text(lab, 0, text, 8, &n));
}

static void model_handle(labspec_status wanted, labspec_model *model)
{
    double x[8] = {0};
    uint8_t bytes[8];
    size_t n = 0;
    char text[8];
    labspec_data *data = (labspec_data *)WRONG[0];
    LAB(labspec_model_to_bytes(model, bytes, 8, &n));
    LAB(labspec_model_read(model, "nv", x, 8, &n));
    LAB(labspec_model_write(model, "body_mass", 0, x, 1));
    LAB(labspec_model_object_count(model, "body", &n));
    LAB(labspec_model_id(model, "body", "bob", &n));
    LAB(labspec_model_name(model, "body", 1, text, 8, &n));
    LAB(labspec_data_new(model, &data));
    CHECK(data == NULL);
}

static void data_handle(labspec_status wanted, labspec_data *data)
{
    double x[8] = {0};
    uint8_t bytes[8] = {0};
    size_t n = 0;
    LAB(labspec_data_step(data, 1));
    LAB(labspec_data_forward(data));
    LAB(labspec_data_inverse(data));
    LAB(labspec_data_reset(data));
    LAB(labspec_data_reset_keyframe(data, 0));
    LAB(labspec_data_set_const(data));
    LAB(labspec_data_time(data, x));
    LAB(labspec_data_read(data, "qpos", x, 8, &n));
    LAB(labspec_data_write(data, "qpos", 0, x, 1));
    LAB(labspec_data_save(data, bytes, 8, &n));
    LAB(labspec_data_restore(data, bytes, 8));
    int32_t geom = 0;
    labspec_contact contact = {.struct_size = sizeof contact};
    LAB(labspec_data_contact_count(data, &n));
    LAB(labspec_data_contact(data, 0, &contact));
    LAB(labspec_data_ray(data, x, x + 1, 1, -1, &geom, x, x));
    LAB(labspec_data_jacobian(data, "body", 1, NULL, x, 8, &n));
    LAB(labspec_data_mass_matrix(data, x, 8, &n));
}

static void report_handle(labspec_status wanted, labspec_check_report *report)
{
    size_t n = 0;
    labspec_outcome outcome = LABSPEC_OUTCOME_CLEAN;
    labspec_finding finding = {.struct_size = sizeof finding};
    labspec_claim claim = {.struct_size = sizeof claim};
    const char *json = NULL;
    LAB(labspec_check_report_outcome(report, &outcome));
    LAB(labspec_check_report_finding_count(report, &n));
    LAB(labspec_check_report_finding(report, 0, &finding));
    LAB(labspec_check_report_claim_count(report, &n));
    LAB(labspec_check_report_claim(report, 0, &claim));
    LAB(labspec_check_report_json(report, &json));
}

/* NULL, and pointers that are no handles. Freeing NULL is nothing. */
static void no_handles(void)
{
    lab_handle(LABSPEC_ERROR_NULL, NULL);
    model_handle(LABSPEC_ERROR_NULL, NULL);
    data_handle(LABSPEC_ERROR_NULL, NULL);
    report_handle(LABSPEC_ERROR_NULL, NULL);
    OK(labspec_lab_free(NULL));
    OK(labspec_lab_state_free(NULL));
    OK(labspec_model_free(NULL));
    OK(labspec_data_free(NULL));
    OK(labspec_check_report_free(NULL));
    for (size_t i = 0; i < WRONGS; i++) {
        lab_handle(LABSPEC_ERROR_HANDLE, WRONG[i]);
        model_handle(LABSPEC_ERROR_HANDLE, WRONG[i]);
        data_handle(LABSPEC_ERROR_HANDLE, WRONG[i]);
        report_handle(LABSPEC_ERROR_HANDLE, WRONG[i]);
        FAILS(HANDLE, labspec_lab_free(WRONG[i]));
        FAILS(HANDLE, labspec_lab_state_free(WRONG[i]));
        FAILS(HANDLE, labspec_model_free(WRONG[i]));
        FAILS(HANDLE, labspec_data_free(WRONG[i]));
        FAILS(HANDLE, labspec_check_report_free(WRONG[i]));
    }
}

/* Functions that create handles. */
static void constructors(void)
{
    labspec_lab *lab = NULL;
    labspec_model *model = NULL;
    labspec_check_report *report = NULL;
    uint8_t bytes[100] = {1};
    FAILS(NULL, labspec_lab_open(LAB, &models, NULL));
    FAILS(NULL, labspec_lab_open(NULL, &models, &lab));
    FAILS(TEXT, labspec_lab_open(BAD, &models, &lab));
    FAILS(ALIGNMENT, labspec_lab_open(LAB, &models, MISALIGNED(labspec_lab *)));
    FAILS(FINDINGS, labspec_lab_open("{", &models, &lab));
    OK(labspec_last_error_report(&report) == LABSPEC_OK && labspec_last_error_status() == LABSPEC_ERROR_FINDINGS
           ? labspec_check_report_free(report) : LABSPEC_ERROR_INTERNAL);
    FAILS(FINDINGS, labspec_lab_open(LAB, NULL, &lab));
    FAILS(NULL, labspec_last_error_report(NULL));
    FAILS(ALIGNMENT, labspec_last_error_report(MISALIGNED(labspec_check_report *)));
    FAILS(NULL, labspec_lab_open_lesson(NULL, LESSON, "#1", &models, &lab));
    FAILS(NULL, labspec_lab_open_lesson("a.md", NULL, "#1", &models, &lab));
    FAILS(NULL, labspec_lab_open_lesson("a.md", LESSON, NULL, &models, &lab));
    FAILS(NULL, labspec_lab_open_lesson("a.md", LESSON, "#1", &models, NULL));
    FAILS(ARGUMENT, labspec_lab_open_lesson("a.md", LESSON, "#2", &models, &lab));
    FAILS(ARGUMENT, labspec_lab_open_lesson("a.md", LESSON, "", &models, &lab));
    FAILS(TEXT, labspec_lab_open_lesson("a.md", BAD, "#1", &models, &lab));
    CHECK(lab == NULL);
    FAILS(NULL, labspec_model_from_xml(NULL, NULL, &model));
    FAILS(NULL, labspec_model_from_xml(DROP, NULL, NULL));
    FAILS(TEXT, labspec_model_from_xml(BAD, NULL, &model));
    FAILS(FINDINGS, labspec_model_from_xml("<mujoco><wordbody/></mujoco>", NULL, &model));
    FAILS(FINDINGS, labspec_model_from_xml("", NULL, &model));
    FAILS(NULL, labspec_model_from_file(NULL, &model));
    FAILS(NULL, labspec_model_from_file("x.xml", NULL));
    FAILS(FILE, labspec_model_from_file("/no/such/file.xml", &model));
    FAILS(NULL, labspec_model_from_bytes(NULL, 1, &model));
    FAILS(NULL, labspec_model_from_bytes(bytes, 100, NULL));
    FAILS(STATE, labspec_model_from_bytes(NULL, 0, &model));
    FAILS(STATE, labspec_model_from_bytes(bytes, 100, &model));
    FAILS(LENGTH, labspec_model_from_bytes(bytes, SIZE_MAX, &model));
    FAILS(NULL, labspec_check(NULL, LESSON, &models, NULL, &report));
    FAILS(NULL, labspec_check("a.md", NULL, &models, NULL, &report));
    FAILS(NULL, labspec_check("a.md", LESSON, &models, NULL, NULL));
    FAILS(TEXT, labspec_check("a.md", BAD, &models, NULL, &report));
    CHECK(model == NULL && report == NULL);
}

/* Structs that the caller passes. */
static void input_structs(void)
{
    labspec_model *model = NULL;
    labspec_check_report *report = NULL;
    labspec_model_source wrong = models;
    const char *bad[1] = {BAD}, *null[1] = {NULL};
    const size_t sizes[] = {0, 1, sizeof wrong - 1, 4097, SIZE_MAX};
    for (size_t i = 0; i < sizeof sizes / sizeof *sizes; i++) {
        wrong.struct_size = sizes[i];
        FAILS(STRUCT_SIZE, labspec_model_from_xml(DROP, &wrong, &model));
        labspec_texts related = {.struct_size = sizes[i] == sizeof wrong - 1 ? sizeof related - 1 : sizes[i]};
        FAILS(STRUCT_SIZE, labspec_check("a.md", LESSON, &models, &related, &report));
    }
    FAILS(ALIGNMENT, labspec_model_from_xml(DROP, MISALIGNED(labspec_model_source), &model));
    wrong = models, wrong.names = NULL;
    FAILS(NULL, labspec_model_from_xml(DROP, &wrong, &model));
    wrong = models, wrong.texts = null;
    FAILS(NULL, labspec_model_from_xml(DROP, &wrong, &model));
    wrong = models, wrong.names = bad;
    FAILS(TEXT, labspec_model_from_xml(DROP, &wrong, &model));
    wrong = models, wrong.count = SIZE_MAX;
    FAILS(LENGTH, labspec_model_from_xml(DROP, &wrong, &model));
    wrong = models, wrong.folder = ".";
    FAILS(ARGUMENT, labspec_model_from_xml(DROP, &wrong, &model));
    wrong.count = 0, wrong.folder = "/no/such/folder";
    FAILS(FILE, labspec_model_from_xml(DROP, &wrong, &model));
    FAILS(FILE, labspec_check("a.md", LESSON, &wrong, NULL, &report));
    /* A newer program: its struct is larger. */
    struct { labspec_model_source known; size_t newer[4]; } larger = {models, {1, 2, 3, 4}};
    larger.known.struct_size = sizeof larger;
    OK(labspec_model_from_xml(DROP, &larger.known, &model));
    OK(labspec_model_free(model));
}

/* Arguments of a lab. */
static void lab_arguments(labspec_lab *lab, labspec_lab_state *foreign)
{
    double x[8] = {0}, h = 0;
    size_t n = 0;
    char text[64] = "as before";
    const char *option = NULL;
    labspec_lab_state *state = NULL;
    FAILS(ARGUMENT, labspec_lab_step(lab, SIZE_MAX));
    FAILS(ARGUMENT, labspec_lab_play_to(lab, NAN, &n));
    FAILS(ARGUMENT, labspec_lab_play_to(lab, INFINITY, &n));
    FAILS(ALIGNMENT, labspec_lab_play_to(lab, 1, MISALIGNED(size_t)));
    OK(labspec_lab_play_to(lab, -INFINITY, NULL));
    FAILS(NULL, labspec_lab_time(lab, NULL));
    FAILS(ALIGNMENT, labspec_lab_time(lab, MISALIGNED(double)));
    FAILS(NULL, labspec_lab_timestep(lab, NULL));
    FAILS(NULL, labspec_lab_is_over(lab, NULL));
    FAILS(LENGTH, labspec_lab_apply_force(lab, 1, x, 5));
    FAILS(LENGTH, labspec_lab_apply_force(lab, 1, x, SIZE_MAX));
    FAILS(NULL, labspec_lab_apply_force(lab, 1, NULL, 6));
    FAILS(ARGUMENT, labspec_lab_apply_force(lab, SIZE_MAX, x, 6));
    FAILS(NULL, labspec_lab_record(lab, 1, NULL, 9, &n));
    FAILS(NULL, labspec_lab_record(lab, 1, NULL, 0, NULL));
    FAILS(ARGUMENT, labspec_lab_record(lab, SIZE_MAX, x, 8, &n));
    FAILS(BUFFER, labspec_lab_record(lab, 2, x, 8, &n));
    CHECK(n == 9);
    OK(labspec_lab_record(lab, 2, NULL, 0, &n));
    OK(labspec_lab_time(lab, &h));
    CHECK(n == 9 && h == 0);
    FAILS(NAME, labspec_lab_read(lab, "qposs", x, 8, &n));
    CHECK(strstr(labspec_last_error(), "did you mean `qpos`") != NULL);
    FAILS(NULL, labspec_lab_read(lab, NULL, x, 8, &n));
    FAILS(TEXT, labspec_lab_read(lab, BAD, x, 8, &n));
    FAILS(BUFFER, labspec_lab_read(lab, "qpos", x, 6, &n));
    CHECK(n == 7);
    FAILS(NULL, labspec_lab_model(lab, NULL));
    FAILS(NULL, labspec_lab_findings(lab, NULL));
    FAILS(NULL, labspec_lab_save(lab, NULL));
    FAILS(NULL, labspec_lab_restore(lab, NULL));
    FAILS(HANDLE, labspec_lab_restore(lab, (labspec_lab_state *)lab));
    FAILS(STATE, labspec_lab_restore(lab, foreign));
    OK(labspec_lab_save(lab, &state));
    OK(labspec_lab_state_free(state));
    FAILS(HANDLE, labspec_lab_restore(lab, state));
    FAILS(HANDLE, labspec_lab_state_free(state));
    FAILS(NULL, labspec_lab_control_count(lab, NULL));
    FAILS(INDEX, labspec_lab_control_option(lab, 1, 2, &option));
    FAILS(INDEX, labspec_lab_control_option(lab, 0, 0, &option));
    FAILS(INDEX, labspec_lab_control_option(lab, SIZE_MAX, 0, &option));
    FAILS(NULL, labspec_lab_control_option(lab, 1, 0, NULL));
    FAILS(NAME, labspec_lab_control_number(lab, "gravty", &h));
    FAILS(NULL, labspec_lab_control_number(lab, "gravity", NULL));
    FAILS(NULL, labspec_lab_control_text(lab, NULL, text, 64, &n));
    FAILS(BUFFER, labspec_lab_control_text(lab, "gravity", text, 4, &n));
    CHECK(n == 4 && strcmp(text, "as before") == 0);
    FAILS(NULL, labspec_lab_set_number(lab, NULL, 1));
    FAILS(TEXT, labspec_lab_set_number(lab, BAD, 1));
    FAILS(NAME, labspec_lab_set_number(lab, "", 1));
    FAILS(ARGUMENT, labspec_lab_set_number(lab, "gravity", NAN));
    FAILS(ARGUMENT, labspec_lab_set_number(lab, "gravity", -21));
    FAILS(ARGUMENT, labspec_lab_set_number(lab, "kick", 1));
    FAILS(ARGUMENT, labspec_lab_set_text(lab, "push", "perhaps"));
    FAILS(NULL, labspec_lab_set_text(lab, "push", NULL));
    FAILS(ARGUMENT, labspec_lab_set_boolean(lab, "gravity", 1));
    FAILS(ARGUMENT, labspec_lab_press(lab, "gravity"));
    FAILS(NAME, labspec_lab_press(lab, "kik"));
    FAILS(NULL, labspec_lab_displayed_count(lab, NULL));
    FAILS(BUFFER, labspec_lab_numbers(lab, x, 1, &n));
    FAILS(ALIGNMENT, labspec_lab_numbers(lab, MISALIGNED(double), 8, &n));
    FAILS(INDEX, labspec_lab_text(lab, 2, text, 64, &n));
    FAILS(BUFFER, labspec_lab_text(lab, 1, text, 4, &n));
    OK(labspec_lab_text(lab, 1, text, 5, NULL));
    CHECK(strcmp(text, "1.00") == 0);
}

/* Structs that the library fills: older and newer programs, and wrong sizes. */
static void output_structs(labspec_lab *lab)
{
    labspec_control control = {.struct_size = sizeof control};
    labspec_displayed displayed = {.struct_size = 0};
    labspec_field field = {.struct_size = sizeof field};
    FAILS(INDEX, labspec_lab_control(lab, 3, &control));
    FAILS(NULL, labspec_lab_control(lab, 0, NULL));
    FAILS(ALIGNMENT, labspec_lab_control(lab, 0, MISALIGNED(labspec_control)));
    control.struct_size--;
    FAILS(STRUCT_SIZE, labspec_lab_control(lab, 0, &control));
    FAILS(STRUCT_SIZE, labspec_lab_displayed(lab, 0, &displayed));
    displayed.struct_size = sizeof displayed;
    OK(labspec_lab_displayed(lab, 0, &displayed));
    CHECK(strcmp(displayed.unit, "m") == 0 && displayed.place == LABSPEC_DISPLAYED_TRACE);
    struct { labspec_control known; size_t newer; } larger = {.newer = 7};
    larger.known.struct_size = sizeof larger;
    OK(labspec_lab_control(lab, 0, &larger.known));
    CHECK(larger.newer == 7 && larger.known.struct_size == sizeof larger && larger.known.max == -1);
    FAILS(INDEX, labspec_field_at(labspec_field_count(), &field));
    FAILS(NULL, labspec_field_at(0, NULL));
    FAILS(NAME, labspec_field_by_name("opt.", &field));
    FAILS(NULL, labspec_field_by_name(NULL, &field));
    OK(labspec_field_by_name("data.qpos", &field));
    CHECK(strcmp(field.name, "qpos") == 0 && field.writable == 1 && strcmp(field.shape, "nq") == 0);
}

static void model_arguments(labspec_model *model)
{
    double x[8] = {0};
    size_t n = 0;
    char text[8];
    FAILS(NAME, labspec_model_read(model, "qpos", x, 8, &n));
    FAILS(BUFFER, labspec_model_read(model, "opt.gravity", x, 2, &n));
    FAILS(NULL, labspec_model_read(model, "nv", NULL, 0, NULL));
    FAILS(READ_ONLY, labspec_model_write(model, "nv", 0, x, 1));
    FAILS(READ_ONLY, labspec_model_write(model, "body_parentid", 0, x, 1));
    FAILS(NAME, labspec_model_write(model, "qpos", 0, x, 1));
    FAILS(NULL, labspec_model_write(model, "body_mass", 0, NULL, 1));
    FAILS(LENGTH, labspec_model_write(model, "body_mass", 1, x, 2));
    FAILS(LENGTH, labspec_model_write(model, "body_mass", SIZE_MAX, x, 1));
    FAILS(LENGTH, labspec_model_write(model, "body_mass", 0, x, SIZE_MAX));
    FAILS(NAME, labspec_model_object_count(model, "bodies", &n));
    FAILS(NULL, labspec_model_object_count(model, "body", NULL));
    FAILS(NAME, labspec_model_id(model, "body", "bop", &n));
    FAILS(NAME, labspec_model_id(model, "body", "", &n));
    FAILS(INDEX, labspec_model_name(model, "body", 2, text, 8, &n));
    FAILS(BUFFER, labspec_model_name(model, "body", 0, text, 3, &n));
    FAILS(BUFFER, labspec_model_to_bytes(model, (uint8_t *)text, 8, &n));
    CHECK(n > 8);
}

static void data_arguments(labspec_data *data)
{
    double x[8] = {0.5};
    uint8_t bytes[8] = {0};
    size_t n = 0;
    FAILS(INDEX, labspec_data_reset_keyframe(data, 1));
    FAILS(NULL, labspec_data_time(data, NULL));
    FAILS(NAME, labspec_data_read(data, "", x, 8, &n));
    FAILS(BUFFER, labspec_data_read(data, "qpos", x, 6, &n));
    FAILS(NULL, labspec_data_read(data, "qpos", NULL, 8, &n));
    FAILS(READ_ONLY, labspec_data_write(data, "xpos", 0, x, 1));
    FAILS(NAME, labspec_data_write(data, "body_mass", 0, x, 1));
    FAILS(LENGTH, labspec_data_write(data, "qpos", 0, x, 8));
    FAILS(LENGTH, labspec_data_write(data, "qpos", 7, x, 1));
    FAILS(ALIGNMENT, labspec_data_write(data, "qpos", 0, MISALIGNED(double), 1));
    OK(labspec_data_write(data, "qpos", 7, NULL, 0));
    FAILS(BUFFER, labspec_data_save(data, bytes, 8, &n));
    FAILS(STATE, labspec_data_restore(data, bytes, 8));
    FAILS(STATE, labspec_data_restore(data, NULL, 0));
    FAILS(NULL, labspec_data_restore(data, NULL, 8));
    int32_t geom = 0;
    labspec_contact contact = {.struct_size = sizeof contact};
    FAILS(NULL, labspec_data_contact_count(data, NULL));
    FAILS(INDEX, labspec_data_contact(data, 1000, &contact));
    FAILS(NULL, labspec_data_ray(data, NULL, x, 1, -1, &geom, NULL, NULL));
    FAILS(NULL, labspec_data_ray(data, x, NULL, 1, -1, &geom, NULL, NULL));
    FAILS(NULL, labspec_data_ray(data, x, x, 1, -1, NULL, NULL, NULL));
    FAILS(ALIGNMENT, labspec_data_ray(data, x, x, 1, -1, &geom, NULL, MISALIGNED(double)));
    FAILS(NAME, labspec_data_jacobian(data, "bodi", 1, NULL, NULL, 0, &n));
    FAILS(NULL, labspec_data_jacobian(data, "point", 1, NULL, NULL, 0, &n));
    FAILS(INDEX, labspec_data_jacobian(data, "body", 1000, NULL, NULL, 0, &n));
    FAILS(BUFFER, labspec_data_jacobian(data, "body", 1, NULL, x, 8, &n));
    FAILS(BUFFER, labspec_data_mass_matrix(data, x, 8, &n));
    FAILS(NULL, labspec_data_new((labspec_model *)NULL, &data));
    CHECK(data == NULL);
}

static void report_arguments(labspec_check_report *report)
{
    labspec_finding finding = {.struct_size = sizeof finding};
    labspec_claim claim = {.struct_size = sizeof claim - 1};
    size_t n = 0;
    const char *json = NULL;
    FAILS(NULL, labspec_check_report_outcome(report, NULL));
    FAILS(NULL, labspec_check_report_finding_count(report, NULL));
    FAILS(NULL, labspec_check_report_claim_count(report, NULL));
    FAILS(NULL, labspec_check_report_json(report, NULL));
    OK(labspec_check_report_finding_count(report, &n));
    FAILS(INDEX, labspec_check_report_finding(report, n, &finding));
    FAILS(NULL, labspec_check_report_finding(report, 0, NULL));
    FAILS(STRUCT_SIZE, labspec_check_report_claim(report, 0, &claim));
    FAILS(INDEX, labspec_check_report_claim(report, SIZE_MAX, &claim));
    OK(labspec_check_report_finding(report, 0, &finding));
    CHECK(finding.severity == LABSPEC_SEVERITY_ERROR && strcmp(finding.code, "unknown-object") == 0);
    CHECK(finding.line == 3 && finding.column == 66 && strcmp(finding.file, "a.md") == 0);
    OK(labspec_check_report_json(report, &json));
    CHECK(strstr(json, "\"code\":\"unknown-object\"") != NULL);
}

/* The numbers of a lab after 50 steps. */
static double height_of(labspec_lab *lab)
{
    double all[2] = {0};
    OK(labspec_lab_reset(lab));
    OK(labspec_lab_step(lab, 50));
    OK(labspec_lab_numbers(lab, all, 2, NULL));
    return all[0];
}

int main(void)
{
    labspec_lab *lab = NULL, *other = NULL;
    labspec_lab_state *state = NULL;
    labspec_model *model = NULL;
    labspec_data *data = NULL;
    labspec_check_report *report = NULL;
    CHECK(labspec_abi_version() == LABSPEC_ABI_VERSION && labspec_version()[0] != 0);
    CHECK(strcmp(labspec_status_name(-1), "unknown status") == 0);
    no_handles();
    constructors();
    input_structs();

    OK(labspec_lab_open(LAB, &models, &lab));
    OK(labspec_lab_open(LAB, &models, &other));
    OK(labspec_lab_save(other, &state));
    OK(labspec_model_from_xml(DROP, NULL, &model));
    OK(labspec_data_new(model, &data));
    OK(labspec_check("a.md", LESSON, &models, NULL, &report));
    double height = height_of(lab);
    OK(labspec_lab_reset(lab));
    lab_arguments(lab, state);
    output_structs(lab);
    CHECK(height == height_of(lab) && height == height_of(other));
    model_arguments(model);
    data_arguments(data);
    report_arguments(report);
    /* Handles of another type. */
    lab_handle(LABSPEC_ERROR_HANDLE, (labspec_lab *)model);
    model_handle(LABSPEC_ERROR_HANDLE, (labspec_model *)data);
    data_handle(LABSPEC_ERROR_HANDLE, (labspec_data *)report);
    report_handle(LABSPEC_ERROR_HANDLE, (labspec_check_report *)lab);
    FAILS(HANDLE, labspec_lab_free((labspec_lab *)data));

    OK(labspec_lab_free(lab));
    OK(labspec_model_free(model));
    OK(labspec_data_step(data, 1));
    OK(labspec_data_free(data));
    OK(labspec_check_report_free(report));
    OK(labspec_lab_free(other));
    OK(labspec_lab_state_free(state));
    /* Handles that were freed, also after new ones were made. */
    labspec_model *again = NULL;
    OK(labspec_model_from_xml(DROP, NULL, &again));
    lab_handle(LABSPEC_ERROR_HANDLE, lab);
    model_handle(LABSPEC_ERROR_HANDLE, model);
    data_handle(LABSPEC_ERROR_HANDLE, data);
    report_handle(LABSPEC_ERROR_HANDLE, report);
    FAILS(HANDLE, labspec_lab_free(lab));
    FAILS(HANDLE, labspec_model_free(model));
    FAILS(HANDLE, labspec_data_free(data));
    FAILS(HANDLE, labspec_check_report_free(report));
    OK(labspec_model_free(again));
    printf("%d calls, %d failures\n", calls, failures);
    return failures != 0;
}
