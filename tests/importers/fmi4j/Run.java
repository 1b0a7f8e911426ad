/* FMUs by FMI4j: each argument is a job (README.md), for each a line says how it went. */

import java.io.*;
import java.nio.*;
import java.nio.file.*;
import java.util.*;
import no.ntnu.ihb.fmi4j.importer.fmi2.*;

public class Run {
    /* All variables of one type: their references, their places in a row. */
    static class Group {
        final List<Long> references = new ArrayList<>();
        final List<Integer> places = new ArrayList<>();

        long[] all() {
            return references.stream().mapToLong(Long::longValue).toArray();
        }
    }

    public static void main(String[] jobs) throws Exception {
        org.apache.log4j.Logger.getRootLogger().setLevel(org.apache.log4j.Level.OFF);
        for (String job : jobs) {
            String told = "ok";
            try {
                run(Files.readAllLines(Path.of(job)));
            } catch (Throwable error) {
                told = error.toString();
            }
            System.out.println(job + "\t" + told.replace('\n', ' '));
            System.out.flush();
        }
    }

    static void run(List<String> lines) throws Exception {
        Map<String, String> keys = new HashMap<>();
        Map<String, Group> groups = new LinkedHashMap<>();
        int width = 0;
        for (String line : lines) {
            String[] parts = line.split("\t");
            if (!parts[0].equals("value")) {
                keys.put(parts[0], parts[1]);
                continue;
            }
            Group group = groups.computeIfAbsent(parts[1], k -> new Group());
            group.references.add(Long.parseLong(parts[2]));
            group.places.add(width++);
        }
        double step = Double.parseDouble(keys.get("step"));
        int steps = Integer.parseInt(keys.get("steps"));
        ByteBuffer row = ByteBuffer.allocate(8 * width).order(ByteOrder.LITTLE_ENDIAN);
        try (Fmu fmu = Fmu.from(new File(keys.get("fmu")));
             CoSimulationSlave slave = fmu.asCoSimulationFmu().newInstance("one");
             OutputStream out = new BufferedOutputStream(new FileOutputStream(keys.get("out")))) {
            if (!slave.simpleSetup(0.0, 0.0, 0.0))
                throw new Exception("setup: " + slave.getLastStatus());
            for (int k = 0; k <= steps; k++) {
                if (k > 0 && !slave.doStep((k - 1) * step, step))
                    throw new Exception("step " + k + ": " + slave.getLastStatus());
                for (Map.Entry<String, Group> one : groups.entrySet())
                    read(slave, one.getKey(), one.getValue(), row);
                out.write(row.array());
            }
            slave.terminate();
        }
    }

    static void read(CoSimulationSlave slave, String type, Group group, ByteBuffer row) {
        long[] references = group.all();
        double[] values = new double[references.length];
        if (type.equals("Real")) {
            slave.readReal(references, values);
        } else if (type.equals("Integer")) {
            int[] read = new int[references.length];
            slave.readInteger(references, read);
            for (int i = 0; i < read.length; i++)
                values[i] = read[i];
        } else {
            boolean[] read = new boolean[references.length];
            slave.readBoolean(references, read);
            for (int i = 0; i < read.length; i++)
                values[i] = read[i] ? 1 : 0;
        }
        for (int i = 0; i < values.length; i++)
            row.putDouble(8 * group.places.get(i), values[i]);
    }
}
