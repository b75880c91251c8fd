/* What the functions do when their arguments are right: states come back, fields and controls change what they name. */
#include "expect.h"

/* Saved data, written fields and names do what they say. */
static void round_trips(labspec_model *model, labspec_data *data)
{
    double first[7], second[7], down[3] = {0, 0, -1};
    size_t n = 0, id = 0;
    char name[8];
    OK(labspec_model_id(model, "body", "bob", &id));
    OK(labspec_model_name(model, "body", id, name, 8, &n));
    CHECK(id == 1 && n == 3 && strcmp(name, "bob") == 0);
    OK(labspec_data_step(data, 10));
    OK(labspec_data_save(data, NULL, 0, &n));
    uint8_t *bytes = malloc(n);
    OK(labspec_data_save(data, bytes, n, NULL));
    OK(labspec_data_step(data, 90));
    OK(labspec_data_read(data, "qpos", first, 7, NULL));
    OK(labspec_data_restore(data, bytes, n));
    OK(labspec_data_step(data, 90));
    OK(labspec_data_read(data, "qpos", second, 7, NULL));
    CHECK(memcmp(first, second, sizeof first) == 0 && first[2] < 1);
    bytes[n / 2] ^= 1, bytes[n - 1] ^= 1;
    FAILS(STATE, labspec_data_restore(data, bytes, n - 1));
    free(bytes);
    OK(labspec_model_write(model, "opt.gravity", 0, down, 3));
    OK(labspec_data_set_const(data));
    OK(labspec_data_reset(data));
    OK(labspec_data_forward(data));
    OK(labspec_data_inverse(data));
    OK(labspec_data_read(data, "qacc", second, 7, &n));
    CHECK(n == 6 && fabs(second[2] + 1) < 1e-12);
}

/* What a student does changes the lab, and a saved state brings it back. */
static void lab_round_trip(labspec_lab *lab)
{
    double value = 0, before[7], after[7] = {0};
    size_t n = 1, steps = 0;
    int32_t is_over = 1;
    char text[8];
    const char *option = NULL;
    labspec_lab_state *state = NULL;
    labspec_check_report *report = NULL;
    labspec_model *model = NULL;
    labspec_outcome outcome = LABSPEC_OUTCOME_FINDINGS;
    OK(labspec_lab_findings(lab, &report));
    OK(labspec_check_report_outcome(report, &outcome));
    OK(labspec_check_report_claim_count(report, &n));
    CHECK(outcome == LABSPEC_OUTCOME_NOTHING && n == 0);
    OK(labspec_check_report_free(report));
    OK(labspec_lab_control_count(lab, &n));
    OK(labspec_lab_control_option(lab, 1, 1, &option));
    CHECK(n == 3 && strcmp(option, "yes") == 0);
    OK(labspec_lab_set_text(lab, "push", option));
    OK(labspec_lab_control_number(lab, "push", &value));
    CHECK(value == 1);
    OK(labspec_lab_set_number(lab, "gravity", -1));
    OK(labspec_lab_control_text(lab, "gravity", text, 8, &n));
    CHECK(strcmp(text, "-1") == 0 && n == 2);
    OK(labspec_lab_model(lab, &model));
    OK(labspec_model_read(model, "opt.gravity", before, 7, &n));
    OK(labspec_model_free(model));
    CHECK(n == 3 && before[2] == -1);
    OK(labspec_lab_play_to(lab, 0.1, &steps));
    OK(labspec_lab_is_over(lab, &is_over));
    CHECK(steps == 50 && is_over == 0);
    OK(labspec_lab_save(lab, &state));
    OK(labspec_lab_press(lab, "kick"));
    OK(labspec_lab_read(lab, "qvel", before, 7, &n));
    CHECK(n == 6 && before[2] == 1);
    before[0] = before[1] = before[3] = before[4] = before[5] = 0, before[2] = 3;
    OK(labspec_lab_apply_force(lab, 1, before, 6));
    for (int i = 0; i < 2; i++) {
        memcpy(before, after, sizeof before);
        OK(labspec_lab_restore(lab, state));
        OK(labspec_lab_step(lab, 20));
        OK(labspec_lab_read(lab, "qpos", after, 7, &n));
    }
    CHECK(memcmp(before, after, sizeof before) == 0 && after[2] < 1 && after[2] > 0.98);
    OK(labspec_lab_restore(lab, state));
    double rows[21][3], value_at_end[2];
    OK(labspec_lab_record(lab, 20, rows[0], 63, &n));
    OK(labspec_lab_numbers(lab, value_at_end, 2, NULL));
    CHECK(n == 63 && fabs(rows[20][0] - rows[0][0] - 0.04) < 1e-12 && rows[20][2] == value_at_end[1]);
    CHECK(rows[20][1] < rows[0][1]);
    OK(labspec_lab_state_free(state));
}

/* A ball of 2 kg that is 1 cm deep in the floor. */
static const char BALL[] = "<mujoco><worldbody><geom type='plane' size='5 5 1'/><body pos='0 0 0.09'><freejoint/>"
                           "<geom size='0.1' mass='2'/></body></worldbody></mujoco>";

/* Contacts, rays, Jacobians and the mass matrix are those of the scene. */
static void geometry(void)
{
    labspec_model *model = NULL;
    labspec_data *data = NULL;
    labspec_contact contact = {.struct_size = sizeof contact};
    const double from[3] = {0, 0, 2}, along[3] = {0, 0, -2};
    double matrix[36], distance = 0, normal[3] = {0};
    size_t n = 0;
    int32_t geom = 7;
    OK(labspec_model_from_xml(BALL, NULL, &model));
    OK(labspec_data_new(model, &data));
    OK(labspec_data_forward(data));
    OK(labspec_data_contact_count(data, &n));
    OK(labspec_data_contact(data, 0, &contact));
    CHECK(n == 1 && contact.geom1 == 0 && contact.geom2 == 1 && contact.dim == 3);
    CHECK(fabs(contact.dist + 0.01) < 1e-12 && contact.frame[2] == 1 && contact.force[0] > 19);
    OK(labspec_data_ray(data, from, along, 1, -1, &geom, &distance, normal));
    CHECK(geom == 1 && fabs(distance - 0.905) < 1e-12 && fabs(normal[2] - 1) < 1e-12);
    OK(labspec_data_ray(data, from, along, 1, 1, &geom, &distance, NULL));
    CHECK(geom == 0 && fabs(distance - 1) < 1e-12);
    OK(labspec_data_ray(data, from, along, 0, 1, &geom, &distance, normal));
    CHECK(geom == -1 && distance == -1 && normal[2] == 0);
    OK(labspec_data_jacobian(data, "body", 1, NULL, matrix, 36, &n));
    CHECK(n == 36 && matrix[0] == 1 && matrix[14] == 1 && matrix[21] == 1);
    OK(labspec_data_jacobian(data, "point", 1, from, matrix, 36, &n));
    CHECK(fabs(matrix[4] - 1.91) < 1e-12 && fabs(matrix[9] + 1.91) < 1e-12);
    OK(labspec_data_mass_matrix(data, matrix, 36, &n));
    CHECK(n == 36 && matrix[0] == 2 && fabs(matrix[35] - 0.008) < 1e-12);
    OK(labspec_model_free(model));
    OK(labspec_data_free(data));
}

int main(void)
{
    geometry();
    labspec_lab *lab = NULL;
    labspec_model *model = NULL;
    labspec_data *data = NULL;
    OK(labspec_lab_open(LAB, &models, &lab));
    OK(labspec_model_from_xml(DROP, NULL, &model));
    OK(labspec_data_new(model, &data));
    lab_round_trip(lab);
    round_trips(model, data);
    OK(labspec_lab_free(lab));
    OK(labspec_model_free(model));
    OK(labspec_data_free(data));
    printf("%d calls, %d failures\n", calls, failures);
    return failures != 0;
}
